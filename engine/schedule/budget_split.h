// Divides a job's time among its layers.

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

// When a layer begins, it gets a share of the remaining time: its weight over the weight of all
// layers that have not begun, times the number of threads, because that many layers run at once. So
// time that a layer does not use goes to those after it, time that it overruns is taken from all of
// them, and no layer gets none. Not thread-safe.
class BudgetSplit {
 public:
  using Clock = Budget::Clock;

  // REQUIRES: threads > 0.
  BudgetSplit(std::optional<Clock::time_point> deadline, int threads)
      : deadline_(deadline), threads_(threads) {
    assert(threads > 0);
  }

  // How much a layer of `paths` paths can gain, without a unit. The time to a good route grows a
  // little faster than the number of paths. A layer that starts from a good route gains less.
  static double Weight(size_t paths, bool from_good_route) {
    constexpr double kGrowth = 1.25;
    constexpr double kGoodRouteShare = 0.25;
    const double weight = std::pow(static_cast<double>(paths) + 1, kGrowth);
    return from_good_route ? kGoodRouteShare * weight : weight;
  }

  // Adds a layer that will begin, or changes the weight of one by `change`.
  void Add(double change) { waiting_ += change; }

  // The time that a layer of this weight may use from `now` on; the largest duration if there is no
  // deadline. REQUIRES: `weight` was added and has not begun.
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
  double waiting_ = 0;  // total weight of the layers that have not begun
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_BUDGET_SPLIT_H_
