// Calls a function again and again.

#ifndef TRAVERSE_SERVER_PERIODIC_H_
#define TRAVERSE_SERVER_PERIODIC_H_

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace traverse {

// From construction to destruction, every `period`, in a thread of its own.
class Periodic {
 public:
  Periodic(std::chrono::nanoseconds period, std::function<void()> call)
      : thread_([this, period, call = std::move(call)] {
          std::unique_lock<std::mutex> lock(mutex_);
          while (!stop_.wait_for(lock, period, [this] { return stopping_; })) call();
        }) {}

  ~Periodic() {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    stop_.notify_all();
    thread_.join();
  }

  Periodic(const Periodic&) = delete;
  Periodic& operator=(const Periodic&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_PERIODIC_H_
