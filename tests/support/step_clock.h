// Clocks for tests that do not depend on the machine.

#ifndef TRAVERSE_TESTS_SUPPORT_STEP_CLOCK_H_
#define TRAVERSE_TESTS_SUPPORT_STEP_CLOCK_H_

#include <atomic>
#include <chrono>
#include <cstdint>
#include <ctime>

#include "engine/base/budget.h"

namespace traverse {

// Time passes only by being asked for: a microsecond each time. Once, at reading `stop_at`, it
// passes by `stop` readings, as if the machine had been stopped. Thread-safe.
class StepClock : public TimeSource {
 public:
  explicit StepClock(int64_t stop_at = -1, int64_t stop = 0) : stop_at_(stop_at), stop_(stop) {}

  Budget::Clock::time_point Now() const override {
    const int64_t reading = readings_++;
    if (reading == stop_at_) readings_ += stop_;
    return At(reading);
  }

  // The time after so many readings.
  static Budget::Clock::time_point At(int64_t reading) {
    return Budget::Clock::time_point(std::chrono::seconds(1)) + std::chrono::microseconds(reading);
  }

  int64_t readings() const { return readings_; }

  // Lets the time of so many readings pass.
  void Pass(int64_t readings) const { readings_ += readings; }

 private:
  const int64_t stop_at_;
  const int64_t stop_;
  mutable std::atomic<int64_t> readings_ = 0;
};

// The time that the thread which asks has had: a deadline by it leaves a search as much work on a
// busy machine.
class ThreadClock : public TimeSource {
 public:
  Budget::Clock::time_point Now() const override {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return Budget::Clock::time_point(std::chrono::seconds(time.tv_sec) +
                                     std::chrono::nanoseconds(time.tv_nsec));
  }
};

}  // namespace traverse

#endif  // TRAVERSE_TESTS_SUPPORT_STEP_CLOCK_H_
