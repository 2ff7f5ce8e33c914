// The search for good multipliers of a Lagrangian relaxation.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_MULTIPLIER_SEARCH_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_MULTIPLIER_SEARCH_H_

#include <cstddef>
#include <vector>

namespace traverse {

// Deflected subgradient steps towards a target (Polyak 1969; Camerini, Fratta and Maffioli 1975).
// One multiplier for each cluster; the subgradient is the number of its visits less one.
class MultiplierSearch {
 public:
  explicit MultiplierSearch(size_t clusters) : best_(clusters), direction_(clusters) {}

  // Records that the lowest walk at `multipliers` costs `value`. True if no value was higher.
  bool Take(const std::vector<double>& multipliers, double value);

  // The multipliers to try after `multipliers`, whose lowest walk costs `value` and visits each
  // cluster visits[cluster] times. `target` is the highest value possible.
  std::vector<double> Next(const std::vector<double>& multipliers, double value, double target,
                           const std::vector<int>& visits);

  // Make steps shorter when they lead nowhere, longer when the relaxation has become stronger.
  void Shorten() { factor_ *= 0.7; }
  void Lengthen() { factor_ = factor_ < 0.5 ? 2 * factor_ : 1; }

  const std::vector<double>& best() const { return best_; }
  double best_value() const { return best_value_; }

 private:
  static constexpr double kDeflection = 0.7;  // share of the last direction that stays

  std::vector<double> best_;       // [cluster]
  std::vector<double> direction_;  // [cluster]
  double best_value_ = 0;
  double factor_ = 1;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_MULTIPLIER_SEARCH_H_
