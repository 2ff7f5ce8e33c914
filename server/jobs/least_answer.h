// How long a job takes on this server now at the least: until greedy has answered it.

#ifndef TRAVERSE_SERVER_JOBS_LEAST_ANSWER_H_
#define TRAVERSE_SERVER_JOBS_LEAST_ANSWER_H_

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "engine/base/budget.h"

namespace traverse {

// What is due goes before all searches, so it waits only for what is due before it, and for the way
// back. That is measured for each caller: the longest of late counts, and is forgotten within
// seconds, because a machine is free again as quickly as it became busy. Not thread-safe.
class LeastAnswer {
 public:
  using Clock = Budget::Clock;
  using Seconds = std::chrono::duration<double>;

  // Notes how long after the end of its search a job ended.
  void NoteLag(Seconds lag, Clock::time_point now) {
    lag_ = std::max(lag, Lag(now));
    at_ = now;
  }

  // Until a job of so many points, to be read and solved by greedy, is answered.
  Seconds Of(double points, Clock::time_point now) const {
    constexpr Seconds kOfPoint{0.5e-6};
    return kOfPoint * points + Lag(now);
  }

 private:
  Seconds Lag(Clock::time_point now) const {
    constexpr Seconds kForgotten{1};
    return lag_ * std::exp2(-(Seconds(now - at_) / kForgotten));
  }

  Seconds lag_{};
  Clock::time_point at_{};
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_LEAST_ANSWER_H_
