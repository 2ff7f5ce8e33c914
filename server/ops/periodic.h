// Calls a function periodically.

#ifndef TRAVERSE_SERVER_OPS_PERIODIC_H_
#define TRAVERSE_SERVER_OPS_PERIODIC_H_

#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "engine/base/mutex.h"

namespace traverse {

// Calls it every `period`, from construction to destruction, in a thread of its own.
class Periodic {
 public:
  Periodic(std::chrono::nanoseconds period, std::function<void()> call)
      : thread_([this, period, call = std::move(call)] {
          MutexLock lock(mutex_);
          auto next = std::chrono::steady_clock::now() + period;
          while (!stopping_) {
            if (stop_.WaitUntil(mutex_, next)) continue;
            call();
            next = std::chrono::steady_clock::now() + period;
          }
        }) {}

  ~Periodic() {
    {
      MutexLock lock(mutex_);
      stopping_ = true;
    }
    stop_.NotifyAll();
    thread_.join();
  }

  Periodic(const Periodic&) = delete;
  Periodic& operator=(const Periodic&) = delete;

 private:
  Mutex mutex_;
  ConditionVariable stop_;
  bool stopping_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_PERIODIC_H_
