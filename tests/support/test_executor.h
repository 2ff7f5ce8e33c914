// Executors for tests of what runs on one.

#ifndef TRAVERSE_TESTS_SUPPORT_TEST_EXECUTOR_H_
#define TRAVERSE_TESTS_SUPPORT_TEST_EXECUTOR_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/executor.h"

namespace traverse {

// Runs tasks on a fixed number of threads, newest first if asked, so that tests see more than one
// order.
class TestExecutor : public Executor {
 public:
  enum class Order { kOldestFirst, kNewestFirst };

  explicit TestExecutor(int threads, Order order = Order::kOldestFirst) : order_(order) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { Work(); });
  }

  // Runs what is left, then stops.
  ~TestExecutor() override {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  void Submit(std::function<void()> task) override {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      tasks_.push_back(std::move(task));
    }
    wake_.notify_one();
  }

 private:
  void Work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      wake_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
      if (tasks_.empty()) return;
      std::function<void()> task;
      if (order_ == Order::kOldestFirst) {
        task = std::move(tasks_.front());
        tasks_.pop_front();
      } else {
        task = std::move(tasks_.back());
        tasks_.pop_back();
      }
      lock.unlock();
      task();
      task = nullptr;
      lock.lock();
    }
  }

  const Order order_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> tasks_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace traverse

#endif  // TRAVERSE_TESTS_SUPPORT_TEST_EXECUTOR_H_
