// Measures how long results take from the end of the search to the end of the call, so that
// deadlines hold even on a busy machine or a slow connection.

#ifndef TRAVERSE_SERVER_JOBS_RETURN_LAG_H_
#define TRAVERSE_SERVER_JOBS_RETURN_LAG_H_

#include <algorithm>
#include <map>
#include <string>

#include "engine/base/budget.h"
#include "engine/base/mutex.h"

namespace traverse {

// The greatest recent value: rises at once and falls slowly, because a missed deadline costs more
// than a shorter search. Not thread-safe.
class FadingMaximum {
 public:
  using Duration = Budget::Clock::duration;

  // Forgets a difference after about this many records.
  explicit FadingMaximum(int records) : records_(records) {}

  void Record(Duration value) {
    value_ = value > value_ ? value : value_ + (value - value_) / records_;
  }
  Duration value() const { return value_; }

 private:
  int records_;
  Duration value_{};
};

// Counted per caller: a caller that reads slowly, or leaves, takes no time from others.
// Thread-safe.
class ReturnLag {
 public:
  using Duration = Budget::Clock::duration;

  // Notes that a call of `caller`, whose deadline ended the search, ended `lag` later.
  void Record(const std::string& caller, Duration lag) {
    MutexLock lock(mutex_);
    if (lags_.size() >= kMostCallers && lags_.count(caller) == 0) lags_.clear();
    lags_.try_emplace(caller, kFadingCalls).first->second.Record(lag);
  }

  // The time to reserve for the way back to `caller`.
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

// How late threads wake up: if others use the cores, a thread continues tens of milliseconds after
// its sleep should end. Thread-safe.
class WakeLateness {
 public:
  using Clock = Budget::Clock;
  using Duration = Clock::duration;

  // The period of the measurement: Tick is called this much later, again and again.
  static constexpr std::chrono::milliseconds kPeriod{20};

  void Tick(Clock::time_point now) {
    MutexLock lock(mutex_);
    if (last_ != Clock::time_point()) lateness_.Record(std::max(Duration(), now - last_ - kPeriod));
    last_ = now;
  }

  // The time to reserve for passing an answer from thread to thread.
  Duration Margin() const {
    MutexLock lock(mutex_);
    return kWakings * lateness_.value();
  }

 private:
  // From the search's thread to the writing one, and from there to the sender.
  static constexpr int kWakings = 2;
  static constexpr int kFadingTicks = 250;  // five seconds

  mutable Mutex mutex_;
  Clock::time_point last_ TRAVERSE_GUARDED_BY(mutex_){};
  FadingMaximum lateness_ TRAVERSE_GUARDED_BY(mutex_){kFadingTicks};
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_RETURN_LAG_H_
