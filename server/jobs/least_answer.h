// How long a job takes on this server now at the least: until greedy has answered it.

#ifndef TRAVERSE_SERVER_JOBS_LEAST_ANSWER_H_
#define TRAVERSE_SERVER_JOBS_LEAST_ANSWER_H_

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "engine/base/budget.h"

namespace traverse {

// Workers take turns, so how long a job waits for its first turn, and then for each further one,
// depends on what the others do. That is measured for each caller: the longest waits of late count,
// and are forgotten within seconds, because a queue is gone as quickly as it comes. Not
// thread-safe.
class LeastAnswer {
 public:
  using Clock = Budget::Clock;
  using Seconds = std::chrono::duration<double>;

  // Notes how long the first task of a job waited for a worker.
  void NoteWait(Seconds wait, Clock::time_point now) {
    wait_ = std::max(wait, Wait(now));
    at_ = now;
  }

  // Until a job of so many points, to be read and solved by greedy, is answered.
  Seconds Of(int64_t points, Clock::time_point now) const {
    constexpr Seconds kOfPoint{0.5e-6};
    constexpr int kTurns = 3;  // to be read, to begin, to be answered
    return kOfPoint * static_cast<double>(points) + kTurns * Wait(now);
  }

 private:
  Seconds Wait(Clock::time_point now) const {
    constexpr Seconds kForgotten{1};
    return wait_ * std::exp2(-(Seconds(now - at_) / kForgotten));
  }

  Seconds wait_{};
  Clock::time_point at_{};
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_LEAST_ANSWER_H_
