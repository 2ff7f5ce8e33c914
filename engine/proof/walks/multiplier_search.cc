#include "engine/proof/walks/multiplier_search.h"

namespace traverse {

bool MultiplierSearch::Take(const std::vector<double>& multipliers, double value) {
  if (value <= best_value_) return false;
  best_value_ = value;
  best_ = multipliers;
  return true;
}

std::vector<double> MultiplierSearch::Next(const std::vector<double>& multipliers, double value,
                                           double target, const std::vector<int>& visits) {
  double square = 0;
  for (size_t c = 0; c < direction_.size(); ++c) {
    direction_[c] = kDeflection * direction_[c] + visits[c] - 1;
    square += direction_[c] * direction_[c];
  }
  std::vector<double> next = multipliers;
  if (square <= 0) return next;
  const double step = factor_ * (target - value) / square;
  for (size_t c = 0; c < next.size(); ++c) next[c] += step * direction_[c];
  return next;
}

}  // namespace traverse
