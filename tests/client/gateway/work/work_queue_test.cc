#include "client/gateway/work/work_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace traverse::gateway {
namespace {

TEST(WorkQueue, PlacesAreBoundedInAllAndByCaller) {
  WorkQueue queue({.workers = 1, .max_requests = 3, .max_requests_per_caller = 2});
  auto first = queue.Enter("a");
  auto second = queue.Enter("a");

  EXPECT_EQ(queue.Enter("a").status().code(), absl::StatusCode::kResourceExhausted);
  auto third = queue.Enter("b");
  EXPECT_TRUE(third.ok());
  EXPECT_EQ(queue.Enter("c").status().code(), absl::StatusCode::kResourceExhausted);
  *first = nullptr;
  EXPECT_TRUE(queue.Enter("a").ok());
  EXPECT_EQ(queue.requests(), 2);
}

TEST(WorkQueue, NoPlaceWhileDraining) {
  WorkQueue queue({});

  queue.StartDraining();

  EXPECT_EQ(queue.Enter("a").status().code(), absl::StatusCode::kUnavailable);
}

// A task that has begun, and ends when it is told to.
class Held {
 public:
  Held(WorkQueue& queue, const std::string& caller, int64_t memory_bytes = 0) {
    std::promise<void> begun;
    queue.Submit(*queue.Enter(caller), memory_bytes, [&begun, gone = go_.get_future().share()] {
      begun.set_value();
      gone.wait();
    });
    begun.get_future().wait();
  }
  void End() { go_.set_value(); }

 private:
  std::promise<void> go_;
};

class TestTime : public TimeSource {
 public:
  std::chrono::steady_clock::time_point Now() const override {
    return std::chrono::steady_clock::time_point(std::chrono::seconds(seconds_));
  }
  void PassSecond() { ++seconds_; }

 private:
  std::atomic<int> seconds_ = 0;
};

// Who is served in which order by one worker, of whom each task takes a second.
std::vector<std::string> Served(const std::vector<std::string>& callers,
                                const std::map<std::string, double>& weights) {
  TestTime time;
  constexpr int64_t kLarge = 100;  // what small ones may pass
  WorkQueue queue({.workers = 1, .max_memory_bytes = 1000, .caller_weights = weights}, &time);
  std::promise<void> all;
  std::vector<std::string> order;
  Held first(queue, "x", kLarge);
  Held other(queue, "y", kLarge);  // the worker for those who have none
  for (const std::string& caller : callers) {
    queue.Submit(*queue.Enter(caller), kLarge, [&, caller] {
      order.push_back(caller);
      time.PassSecond();
      if (order.size() == callers.size()) all.set_value();
    });
  }
  first.End();
  all.get_future().wait();
  other.End();
  return order;
}

TEST(WorkQueue, CallersTakeTurns) {
  const std::vector<std::string> order = Served({"a", "a", "a", "b", "c"}, {});

  EXPECT_EQ(order, (std::vector<std::string>{"a", "b", "c", "a", "a"}));
}

TEST(WorkQueue, WhoHasMoreWeightIsServedMore) {
  const std::vector<std::string> order =
      Served({"a", "a", "a", "u", "u", "u", "u", "u"}, {{"u", 2.5}});

  EXPECT_EQ(order, (std::vector<std::string>{"a", "u", "u", "u", "a", "u", "u", "a"}));
}

TEST(WorkQueue, OneWorkerMoreIsForCallersOfWhomNothingIsUnderWay) {
  WorkQueue queue({.workers = 2});
  Held one(queue, "a");
  Held two(queue, "a");
  queue.Submit(*queue.Enter("a"), 0, [] {});
  std::promise<void> done;

  queue.Submit(*queue.Enter("b"), 0, [&] { done.set_value(); });

  done.get_future().wait();
  EXPECT_EQ(queue.waiting(), 1);
  one.End();
  two.End();
}

// Nobody waits for it any more, and its place is another one's.
TEST(WorkQueue, WhatHasEndedWaitsForNothing) {
  WorkQueue queue({.workers = 1, .max_memory_bytes = 100});
  Held one(queue, "a", 100);
  std::stop_source left;
  std::promise<void> done;
  queue.Submit(*queue.Enter("a"), 100, [] {});
  queue.Submit(*queue.Enter("a"), 100, [&] { done.set_value(); },
               {absl::InfiniteFuture(), left.get_token()});

  left.request_stop();

  done.get_future().wait();
  EXPECT_EQ(queue.waiting(), 1);
  one.End();
}

// A search may last for minutes.
TEST(WorkQueue, FewCallersOfEndlessTasksKeepNoSmallOnesWaiting) {
  WorkQueue queue({.workers = 2, .max_memory_bytes = 1600});
  std::vector<std::unique_ptr<Held>> endless;
  for (const char* caller : {"a", "b", "c", "d", "e"}) {
    endless.push_back(std::make_unique<Held>(queue, caller, 100));
  }
  queue.Submit(*queue.Enter("a"), 100, [] {});
  queue.Submit(*queue.Enter("f"), 101, [] {});
  std::promise<void> done;

  queue.Submit(*queue.Enter("g"), 100, [&] { done.set_value(); });

  done.get_future().wait();
  EXPECT_EQ(queue.waiting(), 2) << "the second one of a caller, and one that is not small";
  for (const auto& task : endless) task->End();
}

// What waits for much memory does not keep others waiting who need little, but for more than it
// leaves.
TEST(WorkQueue, SmallTasksPassWhatWaitsForMemory) {
  WorkQueue queue({.workers = 2, .max_memory_bytes = 1600});
  Held large(queue, "a", 1000);
  queue.Submit(*queue.Enter("b"), 1000, [] {});
  queue.Submit(*queue.Enter("c"), 101, [] {});
  std::promise<void> done;

  queue.Submit(*queue.Enter("d"), 100, [&] { done.set_value(); });

  done.get_future().wait();
  EXPECT_EQ(queue.waiting(), 2);
  large.End();
}

TEST(WorkQueue, SmallTasksBeginWhileMemoryIsShort) {
  WorkQueue queue({.workers = 2, .max_memory_bytes = 1600});
  Held large(queue, "a", 1000);
  queue.SetMemoryShort(true);
  queue.Submit(*queue.Enter("b"), 500, [] {});
  std::promise<void> done;

  queue.Submit(*queue.Enter("c"), 100, [&] { done.set_value(); });

  done.get_future().wait();
  EXPECT_EQ(queue.waiting(), 1);
  large.End();
}

TEST(WorkQueue, TasksWaitForMemory) {
  WorkQueue queue({.workers = 2, .max_memory_bytes = 100});
  std::promise<void> go;
  std::shared_future<void> gone = go.get_future().share();
  std::promise<void> began, done;
  queue.Submit(*queue.Enter("a"), 60, [&, gone] {
    began.set_value();
    gone.wait();
  });
  began.get_future().wait();
  std::atomic<bool> second = false;
  queue.Submit(*queue.Enter("b"), 60, [&] {
    second = true;
    done.set_value();
  });

  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(second);
  EXPECT_EQ(queue.running(), 1);
  EXPECT_EQ(queue.memory_bytes(), 60);
  go.set_value();
  done.get_future().wait();
  EXPECT_TRUE(second);
}

TEST(WorkQueue, TasksThatWaitAtTheEndAreDropped) {
  std::promise<void> began;
  bool second = false;
  {
    WorkQueue queue({.workers = 1});
    queue.Submit(*queue.Enter("a"), 0, [&] {
      began.set_value();
      // Until the end has begun. In steps: it gets its turn on a machine that stood still, too.
      for (int i = 0; i < 50; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    });
    began.get_future().wait();
    queue.Submit(*queue.Enter("a"), 0, [&] { second = true; });
  }

  EXPECT_FALSE(second);
}

}  // namespace
}  // namespace traverse::gateway
