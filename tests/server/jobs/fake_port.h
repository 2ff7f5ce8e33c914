// A stream for tests of JobRun, and strategies for its jobs.

#ifndef TRAVERSE_TESTS_SERVER_JOBS_FAKE_PORT_H_
#define TRAVERSE_TESTS_SERVER_JOBS_FAKE_PORT_H_

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/model/route.h"
#include "engine/strategy/strategy.h"
#include "server/jobs/job_run.h"
#include "server/jobs/worker_pool.h"
#include "tests/support/problems/instances.h"

namespace traverse::testing {

inline constexpr auto kPatience = std::chrono::seconds(10);

// Takes its time, and notices a cancellation.
class SlowStrategy : public Strategy {
 public:
  explicit SlowStrategy(std::chrono::milliseconds time) : time_(time) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const auto end = Budget::Clock::now() + time_;
    while (Budget::Clock::now() < end && !budget.Exhausted()) std::this_thread::yield();
    return {GivenRoute(*problem.plan), StopReason::kLocalOptimum, std::nullopt};
  }
  Solution Resume(const LayerProblem& /*problem*/, const Route& start,
                  Budget& /*budget*/) const override {
    return {start, StopReason::kLocalOptimum, std::nullopt};
  }

 private:
  const std::chrono::milliseconds time_;
};

// A stream whose reader takes what it gets as fast as the test says. Writes are completed by a
// thread of its own, as gRPC's are.
class FakePort : public JobPort {
 public:
  FakePort() : run_(JobRun::Make(*this)), writer_([this] { CompleteWrites(); }) {}

  ~FakePort() override {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      stop_ = true;
      changed_.notify_all();
    }
    writer_.join();
  }

  JobRun& run() { return *run_; }

  // While stalled, no write completes.
  void Stall(bool stalled) {
    std::lock_guard<std::mutex> lock(mutex_);
    stalled_ = stalled;
    changed_.notify_all();
  }

  bool WaitForFinish() {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, kPatience, [this] { return finishes_ > 0; });
  }

  std::vector<std::string> messages() {
    std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }
  absl::Status status() {
    std::lock_guard<std::mutex> lock(mutex_);
    return status_;
  }
  int finishes() {
    std::lock_guard<std::mutex> lock(mutex_);
    return finishes_;
  }
  int encoded() {
    std::lock_guard<std::mutex> lock(mutex_);
    return encoded_;
  }
  int rooms() const { return rooms_; }

  std::atomic<bool> worked_on{false};
  std::function<void()> on_room;

  // JobPort.
  std::string EncodeLayer(const LayerOutcome& outcome, const LayerLabel& label) override {
    std::lock_guard<std::mutex> lock(mutex_);
    ++encoded_;
    return std::to_string(outcome.index) + ":" + std::to_string(label.id);
  }
  std::string EncodeSummary() override { return "summary"; }
  void StartWrite(std::string message, bool /*more_follows*/) override {
    std::lock_guard<std::mutex> lock(mutex_);
    EXPECT_FALSE(writing_) << "a write during a write";
    EXPECT_EQ(finishes_, 0) << "a write after the end";
    messages_.push_back(std::move(message));
    writing_ = true;
    changed_.notify_all();
  }
  void OnRoom() override {
    if (on_room) on_room();
    ++rooms_;
  }
  bool IsWorkedOn() const override { return worked_on; }

  // The transport gives up the write under way.
  void CancelCall() override { Stall(false); }
  void Finish(const absl::Status& status) override {
    std::lock_guard<std::mutex> lock(mutex_);
    EXPECT_FALSE(writing_) << "the end during a write";
    status_ = status;
    ++finishes_;
    changed_.notify_all();
  }

 private:
  void CompleteWrites() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return stop_ || (writing_ && !stalled_); });
      if (stop_) return;
      writing_ = false;
      lock.unlock();
      run_->OnWriteDone(true);
      lock.lock();
    }
  }

  const std::shared_ptr<JobRun> run_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> messages_;
  absl::Status status_;
  int finishes_ = 0;
  int encoded_ = 0;
  std::atomic<int> rooms_{0};
  bool writing_ = false;
  bool stalled_ = false;
  bool stop_ = false;
  std::thread writer_;
};

inline LabelledLayer Layer(uint64_t id) { return {JobLayer{FlatPlan(2), {}, {}}, {id, 2}}; }

inline std::unique_ptr<Strategy> Slow(int milliseconds) {
  return std::make_unique<SlowStrategy>(std::chrono::milliseconds(milliseconds));
}

class JobRunTest : public ::testing::Test {
 protected:
  // In this order: the pool's threads end first, as they use the port.
  FakePort port_;
  WorkerPool pool_{2};
  std::shared_ptr<WorkerPool::Queue> queue_ = pool_.NewQueue("test");
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SERVER_JOBS_FAKE_PORT_H_
