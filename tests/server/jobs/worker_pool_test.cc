#include "server/jobs/worker_pool.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace traverse {
namespace {

// Lets tasks wait until the test says so.
class Gate {
 public:
  void Open() {
    std::lock_guard<std::mutex> lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void Wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return open_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
};

// Lets the only thread of `pool` wait at `gate`, and returns when it does.
void Block(WorkerPool& pool, Gate& gate) {
  pool.NewQueue("blocker")->Submit([&gate] { gate.Wait(); });
  while (pool.busy() == 0) std::this_thread::yield();
}

// Names in the order in which tasks were run by a pool of one thread.
class Order {
 public:
  std::function<void()> Task(const std::string& name) {
    return [this, name] {
      std::lock_guard<std::mutex> lock(mutex_);
      names_ += name;
    };
  }
  std::string names() {
    std::lock_guard<std::mutex> lock(mutex_);
    return names_;
  }

 private:
  std::mutex mutex_;
  std::string names_;
};

// The clock of a pool whose tasks take no time, or the time that they say.
class WorkClock {
 public:
  WorkerPool::WorkClock clock() {
    return [this] { return seconds_.load(); };
  }
  void Work(double seconds) { seconds_ = seconds_ + seconds; }

 private:
  std::atomic<double> seconds_{0};
};

TEST(WorkerPool, RunsEveryTaskOnce) {
  std::atomic<int> runs{0};
  {
    WorkerPool pool(4);
    std::vector<std::thread> submitters;
    for (int s = 0; s < 4; ++s) {
      submitters.emplace_back([&pool, &runs, s] {
        const auto queue = pool.NewQueue("caller " + std::to_string(s % 2));
        for (int i = 0; i < 500; ++i) queue->Submit([&runs] { ++runs; });
      });
    }
    for (std::thread& submitter : submitters) submitter.join();
  }
  EXPECT_EQ(runs, 2000);
}

TEST(WorkerPool, TasksMaySubmitTasks) {
  std::atomic<int> runs{0};
  {
    WorkerPool pool(2);
    const auto queue = pool.NewQueue("a");
    std::function<void(int)> chain = [&](int left) {
      ++runs;
      if (left > 0) queue->Submit([&chain, left] { chain(left - 1); });
    };
    queue->Submit([&chain] { chain(99); });
    while (runs < 100) std::this_thread::yield();
  }
  EXPECT_EQ(runs, 100);
}

TEST(WorkerPool, TasksOfAJobBeginByRankAndThenByAge) {
  Gate gate;
  Order order;
  {
    WorkerPool pool(1);
    const auto queue = pool.NewQueue("a");
    Block(pool, gate);
    queue->SubmitLarge(order.Task("d"), 1, 7);
    queue->SubmitLarge(order.Task("b"), 1, 2);
    queue->SubmitLarge(order.Task("e"), 1, 7);
    queue->SubmitLarge(order.Task("c"), 1, 2);
    queue->SubmitLarge(order.Task("a"), 1, 0);
    gate.Open();
  }
  EXPECT_EQ(order.names(), "abcde");
}

TEST(WorkerPool, JobsOfOneCallerTakeTurns) {
  Gate gate;
  Order order;
  WorkClock clock;
  {
    WorkerPool pool(1, clock.clock());
    const auto large = pool.NewQueue("a");
    const auto small = pool.NewQueue("a");
    Block(pool, gate);
    for (int i = 0; i < 5; ++i) large->Submit(order.Task("L"));
    small->Submit(order.Task("s"));
    small->Submit(order.Task("s"));
    gate.Open();
  }
  EXPECT_EQ(order.names(), "LsLsLLL");
}

TEST(WorkerPool, CallersTakeTurnsHoweverManyJobsTheyHave) {
  Gate gate;
  Order order;
  WorkClock clock;
  {
    WorkerPool pool(1, clock.clock());
    std::vector<std::shared_ptr<WorkerPool::Queue>> many;
    for (int q = 0; q < 4; ++q) many.push_back(pool.NewQueue("many"));
    const auto one = pool.NewQueue("one");
    Block(pool, gate);
    for (const auto& queue : many) {
      queue->Submit(order.Task("m"));
      queue->Submit(order.Task("m"));
    }
    for (int i = 0; i < 3; ++i) one->Submit(order.Task("1"));
    gate.Open();
  }
  EXPECT_EQ(order.names(), "m1m1m1mmmmm");
}

TEST(WorkerPool, CallersHaveEqualTimeHoweverLongTheirTasksTake) {
  Gate gate;
  Order order;
  WorkClock clock;
  {
    WorkerPool pool(1, clock.clock());
    const auto long_tasks = pool.NewQueue("a");
    const auto short_tasks = pool.NewQueue("b");
    Block(pool, gate);
    for (int i = 0; i < 3; ++i) {
      long_tasks->Submit([&, task = order.Task("L")] { task(), clock.Work(3); });
    }
    for (int i = 0; i < 6; ++i) {
      short_tasks->Submit([&, task = order.Task("s")] { task(), clock.Work(1); });
    }
    gate.Open();
  }
  EXPECT_EQ(order.names(), "LsssLsssL");
}

TEST(WorkerPool, ASmallJobIsDoneAtOneGoBesideLargeOnes) {
  Gate gate;
  Order order;
  WorkClock clock;
  {
    WorkerPool pool(1, clock.clock());
    std::vector<std::shared_ptr<WorkerPool::Queue>> large;
    for (int q = 0; q < 4; ++q) large.push_back(pool.NewQueue("a"));
    const auto small = pool.NewQueue("a");
    Block(pool, gate);
    // While the large ones are at work a small job comes, each of whose tasks brings the next.
    std::function<void(int)> stage = [&](int left) {
      order.Task("s")();
      clock.Work(0.001);
      if (left > 0) small->Submit([&stage, left] { stage(left - 1); });
    };
    for (const auto& queue : large) {
      for (int i = 0; i < 10; ++i) {
        const bool small_comes = i == 5 && queue == large[0];
        queue->Submit([&, small_comes, task = order.Task("L")] {
          if (small_comes) small->Submit([&stage] { stage(3); });
          task(), clock.Work(1);
        });
      }
    }
    gate.Open();
    while (pool.waiting() > 0 || pool.busy() > 0) std::this_thread::yield();
  }
  EXPECT_NE(order.names().find("LssssL"), std::string::npos) << order.names();
}

constexpr auto kHour = std::chrono::hours(1);

TEST(WorkerPool, WhatIsDueGoesFirstInTheOrderOfItsTime) {
  Gate gate;
  Order order;
  WorkClock clock;
  const auto now = std::chrono::steady_clock::now();
  {
    WorkerPool pool(1, clock.clock());
    Block(pool, gate);
    std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
    const auto submit = [&](const std::string& name) {
      queues.push_back(pool.NewQueue("a"));
      for (int i = 0; i < 2; ++i) queues.back()->Submit(order.Task(name));
      return queues.back();
    };
    submit("n");
    submit("f")->set_due(now + kHour);
    submit("l")->set_due(now - kHour);
    submit("e")->set_due(now - 2 * kHour);
    submit("c")->set_due(now + kHour);
    queues.back()->set_due(now - 3 * kHour);
    gate.Open();
  }
  EXPECT_EQ(order.names(), "cceellnfnf");
}

TEST(WorkerPool, CallersTakeTurnsWithWhatIsDue) {
  Gate gate;
  Order order;
  WorkClock clock;
  const auto now = std::chrono::steady_clock::now();
  {
    WorkerPool pool(1, clock.clock());
    Block(pool, gate);
    std::vector<std::shared_ptr<WorkerPool::Queue>> queues;
    for (const std::string name : {"m", "m", "1"}) {
      queues.push_back(pool.NewQueue(name));
      queues.back()->set_due(now - kHour);
      for (int i = 0; i < 2; ++i)
        queues.back()->Submit([&, task = order.Task(name)] { task(), clock.Work(1); });
    }
    pool.NewQueue("other")->Submit(order.Task("o"));
    gate.Open();
  }
  EXPECT_EQ(order.names(), "m1m1mmo");
}

TEST(WorkerPool, CountsWhatIsBusyAndWhatWaits) {
  Gate gate;
  WorkerPool pool(2);
  const auto queue = pool.NewQueue("a");
  for (int i = 0; i < 5; ++i) queue->Submit([&gate] { gate.Wait(); });
  while (pool.busy() < 2) std::this_thread::yield();

  EXPECT_EQ(pool.threads(), 2);
  EXPECT_EQ(pool.busy(), 2);
  EXPECT_EQ(pool.waiting(), 3);

  gate.Open();
  while (pool.busy() > 0 || pool.waiting() > 0) std::this_thread::yield();
  EXPECT_EQ(queue->wait().tasks, 5);
}

TEST(WorkerPool, QueuesMayGoBeforeTheirTasks) {
  std::atomic<int> runs{0};
  Gate gate;
  {
    WorkerPool pool(1);
    Block(pool, gate);
    pool.NewQueue("b")->Submit([&runs] { ++runs; });
    gate.Open();
  }
  EXPECT_EQ(runs, 1);
}

TEST(WorkerPool, ThreadsMayBeNicerThanTheOthers) {
  const int mine = getpriority(PRIO_PROCESS, 0);
  int of_worker = -1;
  {
    WorkerPool pool(1, WorkerPool::ThreadCpuSeconds, /*nice=*/3);
    pool.NewQueue("a")->Submit([&of_worker] { of_worker = getpriority(PRIO_PROCESS, 0); });
  }
  EXPECT_EQ(of_worker, std::min(mine + 3, 19));
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), mine);
}

TEST(WorkerPool, FewerThanOneThreadIsOne) {
  std::atomic<int> runs{0};
  {
    WorkerPool pool(0);
    pool.NewQueue("a")->Submit([&runs] { ++runs; });
  }
  EXPECT_EQ(runs, 1);
}

TEST(WorkerPool, ThreadsThatAreDoneTakeTheNextTasks) {
  WorkerPool pool(2);
  const auto queue = pool.NewQueue("a");
  for (int i = 0; i < 50; ++i) {
    queue->Submit([] {});
    while (!queue->idle()) std::this_thread::yield();
  }

  EXPECT_LE(pool.thread_count(), 4u);
}

}  // namespace
}  // namespace traverse
