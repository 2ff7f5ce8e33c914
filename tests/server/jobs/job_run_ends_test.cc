// How a JobRun ends: aborts, stalls, holds, and what happens at the same time.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/jobs/job_run.h"
#include "server/jobs/worker_pool.h"
#include "tests/server/jobs/fake_port.h"
#include "tests/support/problems/instances.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST_F(JobRunTest, AbortStopsTheWorkSoon) {
  port_.run().Start({}, {}, Slow(60'000), *queue_);
  for (uint64_t i = 0; i < 10; ++i) port_.run().Add(Layer(i));
  port_.run().Push();
  port_.run().Close();
  while (pool_.busy() < 2) std::this_thread::yield();

  const std::clock_t begin = std::clock();
  port_.run().Abort(absl::CancelledError("enough"));
  ASSERT_TRUE(port_.WaitForFinish());
  while (pool_.busy() > 0) std::this_thread::yield();

  // Of the ten minutes of work that there were; faults_test.cc measures how soon that is.
  EXPECT_LT(std::clock() - begin, 5 * CLOCKS_PER_SEC);
  EXPECT_EQ(port_.status().code(), absl::StatusCode::kCancelled);
  EXPECT_TRUE(port_.messages().empty());
  EXPECT_EQ(port_.finishes(), 1);
}

TEST_F(JobRunTest, AbortWaitsForTheWriteUnderWay) {
  port_.Stall(true);
  port_.run().Start({}, {}, Slow(0), *queue_);
  for (uint64_t i = 0; i < 3; ++i) port_.run().Add(Layer(i));
  port_.run().Push();
  while (port_.messages().empty()) std::this_thread::yield();

  port_.run().Abort(absl::UnavailableError("going"));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(port_.finishes(), 0);

  port_.Stall(false);
  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.messages().size(), 1u);
  EXPECT_EQ(port_.status().code(), absl::StatusCode::kUnavailable);
}

TEST_F(JobRunTest, FirstAbortWins) {
  port_.run().Start({}, {}, Slow(1000), *queue_);
  port_.run().Add(Layer(1));
  port_.run().Push();

  port_.run().Abort(absl::InvalidArgumentError("first"));
  port_.run().Abort(absl::CancelledError("second"));

  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.status().message(), "first");
  EXPECT_EQ(port_.finishes(), 1);
}

TEST_F(JobRunTest, EndsOfAJobThatNeverStarted) {
  port_.run().Abort(absl::InvalidArgumentError("options: bad"));

  ASSERT_TRUE(port_.WaitForFinish());
  port_.run().Start({}, {}, Slow(0), *queue_);
  port_.run().Add(Layer(1));
  port_.run().Push();
  port_.run().Close();
  EXPECT_EQ(port_.finishes(), 1);
  EXPECT_TRUE(port_.messages().empty());
}

// Calls `meanwhile` as the engine starts a job.
class StartingExecutor : public Executor {
 public:
  StartingExecutor(Executor& executor, std::function<void()> meanwhile)
      : executor_(executor), meanwhile_(std::move(meanwhile)) {}

  void Submit(std::function<void()> task) override { executor_.Submit(std::move(task)); }
  int threads() const override {
    meanwhile_();
    return executor_.threads();
  }

 private:
  Executor& executor_;
  const std::function<void()> meanwhile_;
};

TEST_F(JobRunTest, AnAbortWhileTheEngineStartsIsNotLost) {
  StartingExecutor executor(*queue_, [this] { port_.run().Abort(absl::CancelledError("now")); });

  port_.run().Start({}, {}, Slow(0), executor);

  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.status().message(), "now");
  EXPECT_TRUE(port_.messages().empty());
}

TEST_F(JobRunTest, AJobThatTheEngineHasNoMemoryToStartCanBeAborted) {
  StartingExecutor executor(*queue_, [] { throw std::bad_alloc(); });

  EXPECT_THROW(port_.run().Start({}, {}, Slow(0), executor), std::bad_alloc);
  port_.run().Abort(NoMemory());

  EXPECT_TRUE(port_.WaitForFinish());
}

// Has no memory for its first task.
class FullExecutor : public Executor {
 public:
  explicit FullExecutor(Executor& executor) : executor_(executor) {}

  void Submit(std::function<void()> task) override {
    if (!std::exchange(submitted_, true)) throw std::bad_alloc();
    executor_.Submit(std::move(task));
  }
  int threads() const override { return executor_.threads(); }

 private:
  Executor& executor_;
  bool submitted_ = false;
};

TEST_F(JobRunTest, AJobWhoseLayersTheEngineHasNoMemoryForEnds) {
  FullExecutor executor(*queue_);
  port_.run().Start({}, {}, Slow(0), executor);
  for (uint64_t i = 0; i < 3; ++i) port_.run().Add(Layer(i));

  port_.run().Push();

  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.status(), NoMemory());
}

// Wants more memory than there is, in every layer but the first.
class HungryStrategy : public SlowStrategy {
 public:
  HungryStrategy() : SlowStrategy(std::chrono::milliseconds(0)) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    if (problem.plan->paths.size() > 2) throw std::bad_alloc();
    return SlowStrategy::Solve(problem, budget);
  }
};

TEST_F(JobRunTest, AJobThatRunsOutOfMemoryEndsAlone) {
  const auto queue = pool_.NewQueue("hungry", [this] { port_.run().Abort(NoMemory()); });
  port_.run().Start({}, {}, std::make_unique<HungryStrategy>(), *queue);
  port_.run().Add(Layer(1));
  for (uint64_t i = 2; i < 20; ++i) port_.run().Add({JobLayer{FlatPlan(3), {}, {}}, {i, 3}});
  port_.run().Close();

  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.status().code(), absl::StatusCode::kResourceExhausted);

  FakePort other;
  const auto next = pool_.NewQueue("next");
  other.run().Start({}, {}, Slow(0), *next);
  other.run().Add(Layer(1));
  other.run().Close();
  ASSERT_TRUE(other.WaitForFinish());
  EXPECT_TRUE(other.status().ok());
}

TEST_F(JobRunTest, ACallerWhoDoesNothingIsGivenUp) {
  const absl::Status idle = absl::DeadlineExceededError("idle");
  port_.run().Start({}, {}, Slow(0), *queue_);
  port_.run().Add(Layer(1));
  port_.run().Push();
  port_.run().AbortIfStalled(std::chrono::hours(1), idle);
  EXPECT_FALSE(port_.run().aborted());

  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  port_.run().AbortIfStalled(std::chrono::milliseconds(1), idle);

  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.status(), idle);
}

TEST_F(JobRunTest, AReaderWhoReadsNothingIsGivenUp) {
  port_.Stall(true);
  port_.run().Start({}, {}, Slow(0), *queue_);
  for (uint64_t i = 0; i < 5; ++i) port_.run().Add(Layer(i));
  port_.run().Close();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));

  port_.run().AbortIfStalled(std::chrono::milliseconds(1), absl::DeadlineExceededError("idle"));

  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.status().code(), absl::StatusCode::kDeadlineExceeded);
}

TEST_F(JobRunTest, AJobThatIsWorkedOnIsNotGivenUp) {
  port_.worked_on = true;
  port_.run().Start({}, {}, Slow(0), *queue_);
  std::this_thread::sleep_for(std::chrono::milliseconds(5));

  port_.run().AbortIfStalled(std::chrono::milliseconds(1), absl::DeadlineExceededError("idle"));

  EXPECT_FALSE(port_.run().aborted());
  port_.run().Close();
  ASSERT_TRUE(port_.WaitForFinish());
}

TEST_F(JobRunTest, HoldPostponesTheEnd) {
  ASSERT_TRUE(port_.run().Hold());
  port_.run().Abort(absl::CancelledError("now"));
  EXPECT_EQ(port_.finishes(), 0);

  port_.run().Release();
  EXPECT_EQ(port_.finishes(), 1);
}

TEST_F(JobRunTest, NobodyUsesThePortOfAJobThatHasEnded) {
  port_.run().Abort(absl::CancelledError("now"));
  ASSERT_EQ(port_.finishes(), 1);

  EXPECT_FALSE(port_.run().Hold());
}

// Cancelled in the gap between the lock and the call: the port was deleted in it.
TEST_F(JobRunTest, ACancelWaitsForOnRoom) {
  int finishes_within = -1;
  port_.on_room = [&] {
    std::thread([&] { port_.run().Abort(absl::CancelledError("now")); }).join();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // for the engine's end
    finishes_within = port_.finishes();
  };
  // So slow that nothing is there to be written when the first layer is out: a write keeps the
  // port.
  port_.run().Start({.window = {.layers = 6, .points = 100}, .build_order = false}, {}, Slow(100),
                    *queue_);
  for (uint64_t i = 0; i < 6; ++i) port_.run().Add(Layer(i));
  port_.run().Push();
  EXPECT_FALSE(port_.run().AskForRoom());

  ASSERT_TRUE(port_.WaitForFinish());
  EXPECT_EQ(port_.rooms(), 1);
  EXPECT_EQ(finishes_within, 0);
}

// Aborts at every moment of a job's life; ThreadSanitizer looks on.
TEST(JobRunRaces, AbortAtAnyTimeEndsOnce) {
  for (int round = 0; round < 100; ++round) {
    FakePort port;
    WorkerPool pool(2);
    const auto queue = pool.NewQueue("test");
    ASSERT_TRUE(port.run().Hold());
    std::thread aborter([&port, round] {
      std::this_thread::sleep_for(std::chrono::microseconds(round * 20));
      port.run().Abort(absl::CancelledError("now"));
    });
    port.run().Start({.window = {.layers = 4, .points = 100}, .build_order = round % 2 == 0}, {},
                     Slow(0), *queue);
    for (uint64_t i = 0; i < 50; ++i) {
      port.run().Add(Layer(i));
      port.run().Push();
    }
    port.run().Close();
    port.run().Release();
    aborter.join();
    ASSERT_TRUE(port.WaitForFinish()) << "round " << round;
    EXPECT_EQ(port.finishes(), 1);
  }
}

// A port that is gone, and its run with it, as soon as the job has ended: as a reactor is.
class VanishingPort : public JobPort {
 public:
  VanishingPort(WorkerPool& pool, std::atomic<int>& ended)
      : run_(JobRun::Make(*this)), writes_(pool.NewQueue("writer")), ended_(ended) {}

  void Start(Executor& executor) {
    const std::shared_ptr<JobRun> run = run_;
    EXPECT_TRUE(run->Hold());
    run->Start({}, {}, Slow(0), executor);
    run->Add(Layer(1));
    run->Close();
    run->Release();
  }

  std::string EncodeLayer(const LayerOutcome& /*outcome*/, const LayerLabel& /*label*/) override {
    return "layer";
  }
  std::string EncodeSummary() override { return "summary"; }
  void StartWrite(std::string /*message*/, bool /*more_follows*/) override {
    writes_->Submit([this] { run_->OnWriteDone(true); });
  }
  void OnRoom() override {}
  void Finish(const absl::Status& /*status*/) override {
    // After the reaction that is under way, in another thread.
    writes_->Submit([this] {
      ++ended_;
      delete this;
    });
  }

 private:
  const std::shared_ptr<JobRun> run_;
  const std::shared_ptr<WorkerPool::Queue> writes_;
  std::atomic<int>& ended_;
};

// The summary may be written, and the job end, before the engine's last call returns.
TEST(JobRunRaces, TheRunOutlivesTheEnginesLastCall) {
  constexpr int kJobs = 10'000;
  WorkerPool workers(3);
  std::atomic<int> ended{0};
  {
    WorkerPool writers(1);
    const auto queue = workers.NewQueue("jobs");
    for (int i = 0; i < kJobs; ++i) {
      (new VanishingPort(writers, ended))->Start(*queue);
    }
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (ended < kJobs && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  }

  EXPECT_EQ(ended, kJobs);
}

}  // namespace
}  // namespace traverse
