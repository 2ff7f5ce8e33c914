// A job's time, spread over its layers.

#ifndef TRAVERSE_ENGINE_SCHEDULE_BUDGET_SPLIT_H_
#define TRAVERSE_ENGINE_SCHEDULE_BUDGET_SPLIT_H_

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>

#include "engine/base/budget.h"

namespace traverse {

// Each layer, as it begins, is allotted the share of what time is left that its weight is of all
// weight that has not begun; times the number of threads, as so many layers go on at once. Time
// that a layer does not use is thus left to those after it, time that it takes too much of is taken
// from all of them, and none is left without. Not thread-safe.
class BudgetSplit {
 public:
  using Clock = Budget::Clock;

  // REQUIRES: threads > 0.
  BudgetSplit(std::optional<Clock::time_point> deadline, int threads)
      : deadline_(deadline), threads_(threads) {
    assert(threads > 0);
  }

  // What a layer of so many paths can gain, in no unit: the time to a good route grows a little
  // faster than the number of paths. A layer that starts from a good route gains less.
  static double Weight(size_t paths, bool from_good_route) {
    constexpr double kGrowth = 1.25;
    constexpr double kGoodRouteShare = 0.25;
    const double weight = std::pow(static_cast<double>(paths) + 1, kGrowth);
    return from_good_route ? kGoodRouteShare * weight : weight;
  }

  // A layer that is to begin is known, or weighs `change` more than was thought.
  void Add(double change) { waiting_ += change; }

  // What a layer of this weight may use from `now` on; the largest duration if there is no end.
  // REQUIRES: `weight` was added and has not begun.
  Clock::duration Begin(double weight, Clock::time_point now) {
    assert(weight <= waiting_ * (1 + kRounding) + kRounding);
    const double share = std::min(1.0, threads_ * weight / std::max(waiting_, weight));
    waiting_ = std::max(0.0, waiting_ - weight);
    if (!deadline_) return Clock::duration::max();
    const Clock::duration left = std::max(Clock::duration::zero(), *deadline_ - now);
    return std::chrono::duration_cast<Clock::duration>(share * left);
  }

 private:
  static constexpr double kRounding = 1e-6;  // of sums of weights

  const std::optional<Clock::time_point> deadline_;
  const int threads_;
  double waiting_ = 0;  // weight that has not begun
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_BUDGET_SPLIT_H_
