#include "client/gateway/work/work_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
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

TEST(WorkQueue, CallersTakeTurns) {
  WorkQueue queue({.workers = 1});
  std::promise<void> go;
  std::shared_future<void> gone = go.get_future().share();
  std::promise<void> began, all;
  std::vector<std::string> order;
  queue.Submit(*queue.Enter("x"), 0, [&, gone] {
    began.set_value();
    gone.wait();
  });
  // Else the worker, if it is late, finds all of them and may take "x" after an "a".
  began.get_future().wait();
  for (const std::string caller : {"a", "a", "a", "b", "c"}) {
    queue.Submit(*queue.Enter(caller), 0, [&, caller] {
      order.push_back(caller);
      if (order.size() == 5) all.set_value();
    });
  }

  go.set_value();
  all.get_future().wait();

  EXPECT_EQ(order, (std::vector<std::string>{"a", "b", "c", "a", "a"}));
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
