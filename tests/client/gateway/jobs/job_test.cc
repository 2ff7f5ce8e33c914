#include "client/gateway/jobs/job.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/time/clock.h"

namespace traverse::gateway {
namespace {

// What a reader was told.
struct Told {
  std::vector<uint32_t> revisions;
  std::vector<absl::StatusCode> ends;

  Job::Reader Reader() {
    return {.on_change = [this](const v1::Job& now) { revisions.push_back(now.revision()); },
            .on_end = [this](const absl::Status& why) { ends.push_back(why.code()); }};
  }
};

class JobTest : public ::testing::Test {
 protected:
  JobTest() : spool_(*Spool::Open(::testing::TempDir(), 1 << 20)) {}

  RewrittenFile Made(const std::string& text) {
    std::shared_ptr<SpoolFile> file = *spool_->NewFile("a");
    EXPECT_TRUE(file->Append(text).ok());
    return {.file = file, .report = nullptr, .summary = {}};
  }

  std::unique_ptr<Spool> spool_;
  Job job_{"id", JobWish()};
};

TEST_F(JobTest, TellsWhatIsNewer) {
  Told all, later;
  job_.Follow(0, all.Reader());
  job_.SetProgress({});
  job_.Follow(2, later.Reader());
  job_.SetProgress({});

  EXPECT_EQ(all.revisions, (std::vector<uint32_t>{1, 2, 3}));
  EXPECT_EQ(later.revisions, (std::vector<uint32_t>{3}));
}

TEST_F(JobTest, EndsItsReadersWithItself) {
  Told before, after, unfollowed;
  job_.Follow(0, before.Reader());
  job_.Unfollow(job_.Follow(0, unfollowed.Reader()));
  job_.End(absl::InvalidArgumentError("no file"), absl::Now());
  job_.Follow(0, after.Reader());

  for (const Told& told : {before, after}) {
    EXPECT_EQ(told.revisions.back(), 2u);
    EXPECT_EQ(told.ends, (std::vector<absl::StatusCode>{absl::StatusCode::kOk}));
  }
  EXPECT_TRUE(unfollowed.ends.empty());
}

TEST_F(JobTest, TheOldestReaderGivesWay) {
  std::vector<Told> told(Job::kMostReaders + 1);
  for (Told& one : told) job_.Follow(0, one.Reader());

  EXPECT_EQ(told[0].ends, (std::vector<absl::StatusCode>{absl::StatusCode::kResourceExhausted}));
  for (size_t i = 1; i < told.size(); ++i) EXPECT_TRUE(told[i].ends.empty());
}

TEST_F(JobTest, IsFetchedWhenItsFileWasSentToTheEndAndNobodyReads) {
  job_.End(Made("0123456789"), absl::InfiniteFuture());
  EXPECT_EQ(job_.Now().state(), v1::Job::STATE_DONE);
  EXPECT_FALSE(job_.fetched()) << "its state is not its file";
  {
    const absl::StatusOr<RewrittenFile> made = job_.made();
    char out[10];
    ASSERT_TRUE(made->file->ReadAt(0, out, 10).ok());
  }
  EXPECT_FALSE(job_.fetched()) << "it may not have been sent";
  {
    const absl::StatusOr<RewrittenFile> made = job_.made();
    made->file->NoteSentToEnd();
    EXPECT_FALSE(job_.fetched()) << "another may read it";
  }
  EXPECT_TRUE(job_.fetched());
}

TEST_F(JobTest, AFaultIsFetchedWhenItWasTold) {
  job_.End(absl::FailedPreconditionError("would not print the same"), absl::InfiniteFuture());
  EXPECT_FALSE(job_.fetched());

  const v1::Job now = job_.Now();

  EXPECT_TRUE(job_.fetched());
  EXPECT_EQ(now.fault().http_status(), 422);
  EXPECT_FALSE(job_.may_be_tried_again());
}

TEST_F(JobTest, AFaultIsFetchedByWhoAsksForTheFile) {
  job_.End(absl::FailedPreconditionError("would not print the same"), absl::InfiniteFuture());

  EXPECT_FALSE(job_.made().ok());

  EXPECT_TRUE(job_.fetched());
}

TEST_F(JobTest, WorkThatWasCutOffIsWorthAnotherTry) {
  job_.End(absl::CancelledError("the server has gone"), absl::InfiniteFuture());

  EXPECT_TRUE(job_.may_be_tried_again());
}

TEST_F(JobTest, FaultsThatMayPassAreWorthAnotherTry) {
  job_.End(absl::ResourceExhaustedError("the spool is full"), absl::InfiniteFuture());

  EXPECT_TRUE(job_.may_be_tried_again());
}

}  // namespace
}  // namespace traverse::gateway
