// The cost of moves between entries in a search that prefers some moves to others.
//
// Source: thesis 4.2 (p. 83): a move against the neighborhood costs a penalty of 100, which stands
// for a long move but does not forbid it. SPEC 3.5.

#ifndef TRAVERSE_ENGINE_WELLER_TABU_LINK_COSTS_H_
#define TRAVERSE_ENGINE_WELLER_TABU_LINK_COSTS_H_

#include <vector>

#include "engine/base/symmetric_relation.h"
#include "engine/cost/entry_table.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/layer_problem.h"

namespace traverse {

// Which paths should follow each other: those whose nodes are the same or linked. Other moves cost
// the penalty in addition. By default all may. A negative node may follow all others.
struct LinkRules {
  std::vector<int> node_of = {};              // [path] its node in `linked`
  int start_node = -1;                        // of the start
  const SymmetricRelation* linked = nullptr;  // not owned; null: no rules
  double penalty_mm = 100;                    // a penalty is the cost of a move of that length
};

// Entries are those of `table`, and two more: the problem's start, and its finish (which costs
// nothing to reach if the problem has none). Immutable. Memory: 16 (entries + 2)^2 bytes for up to
// kMatrixEntries entries; beyond that none, and costs are computed on demand.
class LinkCosts {
 public:
  static constexpr int kMatrixEntries = 1000;

  // All arguments must outlive this object.
  LinkCosts(const LayerProblem& problem, const EntryTable& table, const LinkRules& rules);

  int start() const { return table_.entry_count(); }
  int finish() const { return table_.entry_count() + 1; }

  // The cost of the move from the exit of `from` to `to`, including its penalty.
  double operator()(int from, int to) const {
    return matrix_.empty() ? Compute(from, to)
                           : matrix_[static_cast<size_t>(from) * stride_ + static_cast<size_t>(to)];
  }

  // The costs of the moves from one entry to every other, and of those to one entry from every
  // other, [entry]. Null if there is no matrix.
  const double* From(int entry) const {
    return matrix_.empty() ? nullptr : &matrix_[static_cast<size_t>(entry) * stride_];
  }
  const double* To(int entry) const {
    return matrix_.empty() ? nullptr : &transposed_[static_cast<size_t>(entry) * stride_];
  }

  // Whether the move is against the rules.
  bool Penalized(int from, int to) const;

 private:
  double Compute(int from, int to) const;
  int NodeOf(int entry) const;

  const LayerProblem& problem_;
  const EntryTable& table_;
  const LinkRules& rules_;
  TravelCost travel_;
  double penalty_;
  size_t stride_ = 0;
  std::vector<double> matrix_;      // [from * stride_ + to]
  std::vector<double> transposed_;  // [to * stride_ + from]
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_LINK_COSTS_H_
