// How long results take from the end of the search to the end of the call: measured, so that
// deadlines are also kept where the machine is busy or a caller's connection is slow.

#ifndef TRAVERSE_SERVER_JOBS_RETURN_LAG_H_
#define TRAVERSE_SERVER_JOBS_RETURN_LAG_H_

#include <algorithm>
#include <map>
#include <string>

#include "engine/base/budget.h"
#include "engine/base/mutex.h"

namespace traverse {

// The greatest of late: up at once, down slowly, as a deadline that is missed costs more than a
// search that is shorter. Not thread-safe.
class FadingMaximum {
 public:
  using Duration = Budget::Clock::duration;

  // Forgets a difference after about so many records.
  explicit FadingMaximum(int records) : records_(records) {}

  void Record(Duration value) {
    value_ = value > value_ ? value : value_ + (value - value_) / records_;
  }
  Duration value() const { return value_; }

 private:
  int records_;
  Duration value_{};
};

// Of each caller by himself: who reads slowly, or goes away, takes no time from others.
// Thread-safe.
class ReturnLag {
 public:
  using Duration = Budget::Clock::duration;

  // A call of `caller` whose search was ended by its deadline ended `lag` later.
  void Record(const std::string& caller, Duration lag) {
    MutexLock lock(mutex_);
    if (lags_.size() >= kMostCallers && lags_.count(caller) == 0) lags_.clear();
    lags_.try_emplace(caller, kFadingCalls).first->second.Record(lag);
  }

  // The time that should be left to the way back to `caller`.
  Duration Margin(const std::string& caller) const {
    MutexLock lock(mutex_);
    const auto found = lags_.find(caller);
    return found == lags_.end() ? Duration() : found->second.value() * 3 / 2;
  }

 private:
  static constexpr int kFadingCalls = 10;
  static constexpr size_t kMostCallers = 4096;

  mutable Mutex mutex_;
  std::map<std::string, FadingMaximum> lags_ TRAVERSE_GUARDED_BY(mutex_);
};

// How late threads are woken: where others use the cores, a thread goes on tens of milliseconds
// after the time that it slept for. Thread-safe.
class WakeLateness {
 public:
  using Clock = Budget::Clock;
  using Duration = Clock::duration;

  // How often to measure: Tick is called so much later, and then so much later again.
  static constexpr std::chrono::milliseconds kPeriod{20};

  void Tick(Clock::time_point now) {
    MutexLock lock(mutex_);
    if (last_ != Clock::time_point()) lateness_.Record(std::max(Duration(), now - last_ - kPeriod));
    last_ = now;
  }

  // The time that should be left for an answer to pass from thread to thread.
  Duration Margin() const {
    MutexLock lock(mutex_);
    return kWakings * lateness_.value();
  }

 private:
  // From the search's thread to that which writes, and there to be sent.
  static constexpr int kWakings = 2;
  static constexpr int kFadingTicks = 250;  // five seconds

  mutable Mutex mutex_;
  Clock::time_point last_ TRAVERSE_GUARDED_BY(mutex_){};
  FadingMaximum lateness_ TRAVERSE_GUARDED_BY(mutex_){kFadingTicks};
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_RETURN_LAG_H_
