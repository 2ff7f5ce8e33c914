// How long before its deadline a search must end.

#ifndef TRAVERSE_SERVER_JOBS_RETURN_MARGIN_H_
#define TRAVERSE_SERVER_JOBS_RETURN_MARGIN_H_

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "engine/base/budget.h"

namespace traverse {

// A call with a deadline, when its search begins.
struct ReturnConditions {
  using Duration = Budget::Clock::duration;

  Duration left{};     // until the deadline
  int64_t layers = 0;  // number of layers known to come
  int64_t points = 0;  // of these, and of jobs that are due before, for each worker
  Duration lag{};      // ReturnLag::Margin of the caller
  Duration wakings{};  // WakeLateness::Margin
};

// The way back of the last results takes part of the deadline: a tenth of it, from 10 ms to 500 ms,
// or what it took this caller before, if that is more; the time for which threads wait on a busy
// machine; and some time per layer and point, because even a layer without time left is given a
// greedy route, validated and written. But never more than half of the time.
inline ReturnConditions::Duration MarginOfReturn(const ReturnConditions& call) {
  using Duration = ReturnConditions::Duration;
  constexpr auto kMargin = std::chrono::milliseconds(10);
  constexpr auto kMostMargin = std::chrono::milliseconds(500);
  constexpr auto kOfLayer = std::chrono::microseconds(100);
  constexpr auto kOfPoint = std::chrono::nanoseconds(500);
  const auto share = std::chrono::duration_cast<Duration>(call.left * 0.1);
  const Duration base = std::max(std::clamp<Duration>(share, kMargin, kMostMargin), call.lag);
  return std::min<Duration>(call.left / 2,
                            base + call.wakings + call.layers * kOfLayer + call.points * kOfPoint);
}

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_RETURN_MARGIN_H_
