// Work on a file that ends in time: client/gcode/work_limit, and all that asks it.

#include "client/gcode/work_limit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <stop_token>
#include <string>

#include "client/gcode/gcode_job.h"
#include "client/gcode/parallel.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/rewrite.h"
#include "client/gcode/verify/verifier.h"
#include "client/input/input_job.h"
#include "tests/client/gcode/support/samples.h"
#include "tests/client/gcode/support/verified.h"

namespace traverse::gcode {
namespace {

using ::testing::HasSubstr;

const std::string kSample = testing::kPrusaSample;

// Lines enough that whoever reads them looks at the limit.
std::string LongSample() {
  std::string text = kSample;
  for (int i = 0; i < 500; ++i) text += "G1 X" + std::to_string(i) + " Y1 F9000\n";
  return text;
}

WorkLimit Stopped() {
  std::stop_source stop;
  stop.request_stop();
  return {absl::InfiniteFuture(), stop.get_token()};
}

TEST(WorkLimit, EndsOnceAndForAllCopies) {
  std::stop_source stop;
  const WorkLimit limit(absl::InfiniteFuture(), stop.get_token());
  const WorkLimit copy = limit;
  EXPECT_FALSE(limit.Ended());
  EXPECT_EQ(limit.status(), absl::OkStatus());

  stop.request_stop();

  EXPECT_EQ(copy.status(), absl::OkStatus()) << "nobody has ended for it yet";
  EXPECT_TRUE(copy.Ended());
  EXPECT_TRUE(limit.Ended());
  EXPECT_EQ(limit.status().code(), absl::StatusCode::kCancelled);
  const WorkLimit late(absl::InfinitePast(), {});
  EXPECT_TRUE(late.Ended());
  EXPECT_EQ(late.status().code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_FALSE(WorkLimit().Ended());
}

TEST(ParallelFor, StopsWhenTheWorkEnds) {
  std::atomic<int> rounds = 0;
  ParallelFor(
      1000, 4, [&](size_t) { ++rounds; }, Stopped());
  EXPECT_EQ(rounds, 0);
}

// Each thread may be the one for which there is no memory.
TEST(ParallelFor, TellsItsCallerOfWhatIsThrown) {
  for (const size_t at : {0u, 1u, 500u, 999u}) {
    const auto body = [at](size_t i) {
      if (i == at) throw std::bad_alloc();
    };
    EXPECT_THROW(ParallelFor(1000, 4, body), std::bad_alloc);
  }
}

TEST(WorkLimit, EndsReading) {
  EXPECT_EQ(ReadGcode(LongSample(), "a", Stopped()).status().code(), absl::StatusCode::kCancelled);
  GcodeOptions options;
  options.limit = Stopped();
  EXPECT_EQ(ReadGcodeJob(LongSample(), "a", options).status().code(), absl::StatusCode::kCancelled);
}

TEST(WorkLimit, EndsMeasuringAndRewriting) {
  std::stop_source stop;
  GcodeOptions options;
  options.limit = {absl::InfiniteFuture(), stop.get_token()};
  absl::StatusOr<InputJob> job = ReadGcodeJob(kSample, "a", options);
  ASSERT_TRUE(job.ok()) << job.status();
  EXPECT_TRUE(AddMeasuredFacts(*job, options).ok());

  stop.request_stop();

  EXPECT_EQ(AddMeasuredFacts(*job, options).status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(RewriteGcode(*job->gcode, {}, {}).status().code(), absl::StatusCode::kCancelled);
}

// What was compared until then is no proof.
TEST(WorkLimit, EndsVerifyingWithoutAProof) {
  VerifyOptions options;
  options.limit = Stopped();

  const VerifyReport report = CheckGcode(kSample, "a", kSample, "b", options);

  ASSERT_EQ(report.breaks.size(), 1u);
  EXPECT_THAT(report.breaks[0].message, HasSubstr("b: not compared: cancelled"));
  EXPECT_FALSE(VerifyGcode(LongSample(), "a", LongSample(), "b", options).ok());
}

}  // namespace
}  // namespace traverse::gcode
