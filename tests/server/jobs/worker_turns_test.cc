// Tasks that take long give way to others, and answer the watchdog.

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/budget.h"
#include "server/jobs/worker_pool.h"

namespace traverse {
namespace {

using Clock = Budget::Clock;

// A task that works until it is told to end, or its budget runs out. Outlives its pool.
class Endless {
 public:
  std::function<void()> On(const std::shared_ptr<WorkerPool::Queue>& queue,
                           std::optional<Clock::time_point> deadline = std::nullopt) {
    return [this, queue, deadline] {
      Budget budget(&cancel, deadline, queue->turn());
      ++begun;
      while (!budget.Exhausted()) ++steps;
      ++ended;
    };
  }

  CancelToken cancel;
  std::atomic<int> begun{0};
  std::atomic<int> ended{0};
  std::atomic<int64_t> steps{0};
};

// Waits for `condition`; a test that waits for a minute fails, and hangs no suite.
void WaitFor(const std::function<bool()>& condition) {
  const auto end = Clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    ASSERT_LT(Clock::now(), end);
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

TEST(WorkerTurns, AShortJobIsDoneBesideAnyNumberOfEndlessOnes) {
  Endless endless;
  WorkerPool pool(2);
  std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
  for (int i = 0; i < 20; ++i) {
    queues.push_back(pool.NewQueue("caller " + std::to_string(i % 3)));
    for (int task = 0; task < 3; ++task) queues.back()->Submit(endless.On(queues.back()));
  }
  WaitFor([&] { return endless.begun >= 2; });

  for (int i = 0; i < 20; ++i) {
    std::atomic<bool> done{false};
    pool.NewQueue("victim")->Submit([&done] { done = true; });
    WaitFor([&] { return done.load(); });
  }

  EXPECT_EQ(endless.ended, 0);
  EXPECT_LE(pool.busy(), 2);
  endless.cancel.Cancel();
}

TEST(WorkerTurns, LongTasksShareTheirTime) {
  Endless a;
  Endless b;
  WorkerPool pool(1);
  const auto queue_a = pool.NewQueue("a");
  const auto queue_b = pool.NewQueue("b");
  queue_a->Submit(a.On(queue_a));
  queue_b->Submit(b.On(queue_b));
  WaitFor([&] { return queue_a->busy_seconds() + queue_b->busy_seconds() > 0.5; });

  EXPECT_GT(queue_a->busy_seconds(), 0.1);
  EXPECT_GT(queue_b->busy_seconds(), 0.1);
  a.cancel.Cancel();
  b.cancel.Cancel();
}

TEST(WorkerTurns, ACallerWithALargerWeightHasMoreTime) {
  Endless urgent, usual;
  WorkerPool pool(1);
  pool.SetWeights({{"urgent", 4}});
  const auto first = pool.NewQueue("urgent");
  const auto second = pool.NewQueue("usual");
  first->Submit(urgent.On(first));
  second->Submit(usual.On(second));
  WaitFor([&] { return first->busy_seconds() + second->busy_seconds() > 1; });

  EXPECT_GT(first->busy_seconds(), 2.5 * second->busy_seconds());
  urgent.cancel.Cancel();
  usual.cancel.Cancel();
}

TEST(WorkerTurns, APausedTaskEndsAtItsDeadlineAndWhenItIsCancelled) {
  Endless busy;
  Endless cancelled;
  Endless late;
  WorkerPool pool(1);
  std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
  for (int i = 0; i < 8; ++i) {
    queues.push_back(pool.NewQueue("busy " + std::to_string(i)));
    queues.back()->Submit(busy.On(queues.back()));
  }
  queues.push_back(pool.NewQueue("a"));
  queues.back()->Submit(cancelled.On(queues.back()));
  queues.push_back(pool.NewQueue("b"));
  queues.back()->Submit(late.On(queues.back(), Clock::now() + std::chrono::milliseconds(300)));
  WaitFor([&] { return cancelled.begun == 1 && late.begun == 1; });

  cancelled.cancel.Cancel();
  WaitFor([&] { return cancelled.ended == 1 && late.ended == 1; });

  EXPECT_EQ(busy.ended, 0);
  busy.cancel.Cancel();
}

// The threads for what is under way beside paused tasks are made by workers, who are nice already.
TEST(WorkerTurns, NoThreadIsNicerThanTheOthers) {
  constexpr int kTasks = 6;
  Endless endless;
  std::atomic<int> niceness[kTasks] = {};
  const int nice = std::min(getpriority(PRIO_PROCESS, 0) + 1, 19);
  {
    WorkerPool pool(1, WorkerPool::ThreadCpuSeconds, /*nice=*/1);
    std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
    for (std::atomic<int>& mine : niceness) {
      queues.push_back(pool.NewQueue("a"));
      queues.back()->Submit([&mine, run = endless.On(queues.back())] {
        mine = getpriority(PRIO_PROCESS, 0);
        run();
      });
    }
    WaitFor([&] { return endless.begun == kTasks; });
    endless.cancel.Cancel();
  }

  for (const std::atomic<int>& mine : niceness) EXPECT_EQ(mine, nice);
}

// What a thread has worked, as others see it.
class ThreadCpu {
 public:
  void SetThisThread() { pthread_getcpuclockid(pthread_self(), &id_); }
  double Seconds() const {
    timespec time{};
    clock_gettime(id_, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

 private:
  clockid_t id_{};
};

// Each comes soon after another slice of the endless task has begun.
TEST(WorkerTurns, WhatIsDueWaitsForNoSlice) {
  constexpr int kJobs = 100;
  Endless endless;
  ThreadCpu cpu;
  WorkerPool pool(1);
  const auto long_one = pool.NewQueue("a");
  long_one->Submit([&, run = endless.On(long_one)] {
    cpu.SetThisThread();
    run();
  });
  WaitFor([&] { return endless.begun == 1; });

  double waited = 0;  // by what the other one worked meanwhile
  for (int i = 0; i < kJobs; ++i) {
    std::atomic<bool> done{false};
    const auto due = pool.NewQueue("a");
    due->set_due(Clock::now());
    const double begin = cpu.Seconds();
    due->Submit([&] {
      waited += cpu.Seconds() - begin;
      done = true;
    });
    WaitFor([&] { return done.load(); });
  }
  endless.cancel.Cancel();

  EXPECT_LT(waited, 0.1 * kJobs * std::chrono::duration<double>(WorkerPool::kSlice).count());
}

// Nobody gives way to what may not go on.
TEST(WorkerTurns, LargeTasksUnderWayAreFew) {
  Endless endless;
  WorkerPool pool(1);
  std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
  for (int i = 0; i < 8; ++i) {
    queues.push_back(pool.NewQueue("caller " + std::to_string(i)));
    queues.back()->SubmitLarge(endless.On(queues.back()), 1'000'000);
  }
  std::atomic<int> small{0};
  for (int i = 0; i < 30; ++i) {
    const auto queue = pool.NewQueue("small " + std::to_string(i));
    queue->SubmitLarge([&] { ++small; }, 100);
  }
  WaitFor([&] { return small == 30 && endless.begun == 4; });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));

  EXPECT_EQ(endless.begun, 4);
  endless.cancel.Cancel();
  WaitFor([&] { return endless.ended == 8; });
}

// So that searches hold no more memory than there is; those of few points never wait for that.
TEST(WorkerTurns, TasksUnderWayHaveNoMorePointsThanMemoryAllows) {
  WorkerPool pool(1);
  pool.LimitMemory(2 * WorkerPool::kBytesOfPoint * 50'000);
  Endless large;
  Endless middle;
  std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
  for (int i = 0; i < 8; ++i) {
    queues.push_back(pool.NewQueue("caller " + std::to_string(i)));
    queues.back()->SubmitLarge(large.On(queues.back()), 25'000);
    queues.push_back(pool.NewQueue("caller " + std::to_string(i)));
    queues.back()->SubmitLarge(middle.On(queues.back()), 10'000);
  }
  std::atomic<int> small{0};
  for (int i = 0; i < 30; ++i) {
    pool.NewQueue("small " + std::to_string(i))
        ->SubmitLarge([&] { ++small; }, WorkerPool::kSmallPoints);
  }
  WaitFor([&] { return small == 30 && large.begun == 2 && middle.begun == 5; });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));

  EXPECT_EQ(large.begun, 2);
  EXPECT_EQ(middle.begun, 5);
  large.cancel.Cancel();
  middle.cancel.Cancel();
  WaitFor([&] { return large.ended == 8 && middle.ended == 8; });
}

TEST(WorkerTurns, NothingThatHoldsMuchBeginsWhileMemoryIsShort) {
  WorkerPool pool(1);
  pool.SetMemoryShort(true);
  Endless endless;
  std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
  for (int i = 0; i < 4; ++i) {
    queues.push_back(pool.NewQueue("caller " + std::to_string(i)));
    queues.back()->SubmitLarge(endless.On(queues.back()), 10'000);
  }
  std::atomic<int> small{0};
  for (int i = 0; i < 30; ++i) {
    pool.NewQueue("small " + std::to_string(i))
        ->SubmitLarge([&] { ++small; }, WorkerPool::kSmallPoints);
  }
  WaitFor([&] { return small == 30; });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(endless.begun, 1) << "as many as there are permits go on";

  pool.SetMemoryShort(false);

  WaitFor([&] { return endless.begun == 4; });
  endless.cancel.Cancel();
  WaitFor([&] { return endless.ended == 4; });
}

TEST(WorkerTurns, ThreadsThatManyPausesNeededAreGivenBack) {
  WorkerPool pool(1);
  for (int round = 0; round < 3; ++round) {
    Endless endless;
    std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
    for (int i = 0; i < 30; ++i) {
      queues.push_back(pool.NewQueue("caller " + std::to_string(i)));
      queues.back()->Submit(endless.On(queues.back()));
    }
    WaitFor([&] { return endless.begun == 30; });
    EXPECT_GE(pool.thread_count(), 30u);
    endless.cancel.Cancel();
    WaitFor([&] { return endless.ended == 30 && pool.waiting() == 0 && pool.busy() == 0; });
  }
  // A thread ends after the pool counts its task as done.
  WaitFor([&] { return pool.thread_count() <= 3u; });
}

// Each holds a thread, also while it waits.
TEST(WorkerTurns, TasksUnderWayAreBounded) {
  Endless endless;
  WorkerPool pool(1);
  std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
  for (size_t i = 0; i < WorkerPool::kMostUnderWay + 20; ++i) {
    queues.push_back(pool.NewQueue("caller " + std::to_string(i)));
    queues.back()->set_due(Clock::now());  // so that none waits for the slices of those before
    queues.back()->Submit(endless.On(queues.back()));
  }
  WaitFor([&] { return endless.begun >= static_cast<int>(WorkerPool::kMostUnderWay); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));

  EXPECT_EQ(endless.begun, static_cast<int>(WorkerPool::kMostUnderWay));
  endless.cancel.Cancel();
  WaitFor([&] { return endless.ended == static_cast<int>(queues.size()); });
}

TEST(WorkerTurns, APausedTaskTakesNoProcessorTime) {
  Endless paused;
  WorkerPool pool(1);
  const auto queue = pool.NewQueue("paused");
  queue->Submit(paused.On(queue));
  WaitFor([&] { return paused.begun == 1; });
  std::atomic<double> used{-1};
  const auto other = pool.NewQueue("other");
  other->Submit([&used] {
    const std::clock_t before = std::clock();
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    used = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  });
  WaitFor([&] { return used >= 0; });

  EXPECT_LT(used, 0.05);
  paused.cancel.Cancel();
}

TEST(WorkerTurns, SilentTasksAreNamedAndOthersAreNot) {
  Endless answers;
  std::atomic<bool> end{false};
  WorkerPool pool(2);
  const auto good = pool.NewQueue("good");
  const auto bad = pool.NewQueue("bad");
  bad->set_job("job-7");
  good->Submit(answers.On(good));
  bad->Submit([&end] {
    while (!end) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  constexpr auto kLimit = std::chrono::milliseconds(300);
  std::vector<SilentTask> silent;
  WaitFor([&] {
    silent = pool.Silent(kLimit);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return !silent.empty();
  });

  ASSERT_EQ(silent.size(), 1u);
  EXPECT_EQ(silent[0].caller, "bad");
  EXPECT_EQ(silent[0].job, "job-7");
  EXPECT_GT(silent[0].seconds, 0.3);
  end = true;
  WaitFor([&] { return bad->idle(); });
  EXPECT_TRUE(pool.Silent(kLimit).empty());
  answers.cancel.Cancel();
}

}  // namespace
}  // namespace traverse
