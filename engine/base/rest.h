// Asks a budget regularly in loops of many small steps.

#ifndef TRAVERSE_ENGINE_BASE_REST_H_
#define TRAVERSE_ENGINE_BASE_REST_H_

#include <cstddef>

#include "engine/base/budget.h"

namespace traverse {

// For work that must be finished, such as tables and checks of a layer. Other tasks get their turns
// meanwhile, and the budget notes its end for whoever asks next.
//
//   Rest rest(budget);
//   for (const Path& path : plan.paths) {
//     rest(path.points.size());
//     ...
class Rest {
 public:
  // `budget` may be null; then nothing is asked.
  explicit Rest(Budget* budget) : budget_(budget) {}

  // Counts `steps` steps, done or about to be done, of a few nanoseconds each, which may read
  // memory that is not in the cache. Returns false if the budget is exhausted.
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
