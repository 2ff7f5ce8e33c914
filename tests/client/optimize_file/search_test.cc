// A search whose service fails amid the job.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "client/api/embedded.h"
#include "client/formats/read_input.h"
#include "client/optimize_file/optimize_file.h"
#include "tests/client/api/fake_service.h"
#include "tests/support/source_dir.h"

namespace traverse {
namespace {

class SearchTest : public ::testing::Test {
 protected:
  SearchTest()
      : other_(*EmbeddedService::Start(/*threads=*/1)),
        stand_in_(other_->channel()),
        client_(service_.InProcessChannel()) {
    absl::StatusOr<InputJob> job = ReadInput(TRAVERSE_SOURCE_DIR "/deploy/samples/part2.damat");
    EXPECT_TRUE(job.ok()) << job.status();
    job_ = *std::move(job);
    job_.layers.resize(5);
    options_.deadline = absl::Seconds(60);
    options_.stand_in = [this] { return &stand_in_; };
  }

  // The service answers so many layers, then ends the call.
  void FailAfter(uint64_t layers, grpc::StatusCode code) {
    service_.status = grpc::Status(code, "gone");
    service_.layers_before_status = layers;
  }

  absl::StatusOr<report::JobRun> Run() { return Search(client_, job_, options_); }

  testing::FakeService service_;
  const std::unique_ptr<EmbeddedService> other_;
  OptimizerClient stand_in_;
  OptimizerClient client_;
  InputJob job_;
  SearchOptions options_;
};

TEST_F(SearchTest, KeepsWhatWasAnsweredAndDoesTheRestByGreedy) {
  FailAfter(2, grpc::StatusCode::DEADLINE_EXCEEDED);
  int told = 0;
  options_.progress.on_layer = [&](const v1::LayerResult&) { ++told; };

  const absl::StatusOr<report::JobRun> run = Run();

  ASSERT_TRUE(run.ok()) << run.status();
  ASSERT_EQ(run->result.layers.size(), 5u);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(run->result.layers[i].strategy(), i < 2 ? "none" : "greedy") << i;
    EXPECT_EQ(run->result.layers[i].index(), i);
    EXPECT_TRUE(CheckVisits(job_.layers[i], run->result.layers[i]).ok()) << i;
  }
  EXPECT_EQ(run->result.layers[2].start().x_mm(), run->result.layers[1].end().x_mm());
  EXPECT_EQ(run->result.summary.layers(), 5u);
  EXPECT_EQ(run->missed_layers, 3u);
  EXPECT_TRUE(absl::IsDeadlineExceeded(run->missed_because)) << run->missed_because;
  EXPECT_EQ(told, 5);
}

TEST_F(SearchTest, FailsWhereThereIsNothingToKeep) {
  FailAfter(0, grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_TRUE(absl::IsDeadlineExceeded(Run().status()));
}

TEST_F(SearchTest, FailsWithoutADeadlineOrForAFaultOfTheJob) {
  FailAfter(2, grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(absl::IsInvalidArgument(Run().status()));

  FailAfter(2, grpc::StatusCode::DEADLINE_EXCEEDED);
  options_.deadline = absl::InfiniteDuration();
  EXPECT_TRUE(absl::IsDeadlineExceeded(Run().status()));
}

}  // namespace
}  // namespace traverse
