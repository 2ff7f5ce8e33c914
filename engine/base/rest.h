// Asks a budget now and then, in loops of many small steps.

#ifndef TRAVERSE_ENGINE_BASE_REST_H_
#define TRAVERSE_ENGINE_BASE_REST_H_

#include <cstddef>

#include "engine/base/budget.h"

namespace traverse {

// For what has to be done whole, as tables and checks of a layer have: others are let on with
// theirs meanwhile, and the budget notes its end for whoever asks next.
//
//   Rest rest(budget);
//   for (const Path& path : plan.paths) {
//     rest(path.points.size());
//     ...
class Rest {
 public:
  // `budget` may be null: then nobody is asked.
  explicit Rest(Budget* budget) : budget_(budget) {}

  // So many steps of some nanoseconds, each of which may read memory that is not at hand, were
  // done, or are about to be. False if the budget is exhausted.
  bool operator()(size_t steps = 1) {
    if (budget_ == nullptr || (steps_ += steps) < kSteps) return !exhausted_;
    steps_ = 0;
    exhausted_ = budget_->ExhaustedNow();
    return !exhausted_;
  }

 private:
  static constexpr size_t kSteps = 1 << 15;

  Budget* budget_;
  size_t steps_ = 0;
  bool exhausted_ = false;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_REST_H_
