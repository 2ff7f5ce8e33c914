#include "engine/weller/tabu/link_costs.h"

#include <cstddef>

namespace traverse {

LinkCosts::LinkCosts(const LayerProblem& problem, const EntryTable& table, const LinkRules& rules)
    : problem_(problem),
      table_(table),
      rules_(rules),
      travel_(problem),
      penalty_(travel_.OfLength(rules.penalty_mm)) {
  if (table.entry_count() > kMatrixEntries) return;
  stride_ = static_cast<size_t>(table.entry_count()) + 2;
  std::vector<double> matrix(stride_ * stride_);
  transposed_.resize(stride_ * stride_);
  for (int from = 0; from <= start(); ++from) {
    for (int to = 0; to <= finish(); ++to) {
      if (to == start()) continue;
      const double cost = Compute(from, to);
      matrix[static_cast<size_t>(from) * stride_ + static_cast<size_t>(to)] = cost;
      transposed_[static_cast<size_t>(to) * stride_ + static_cast<size_t>(from)] = cost;
    }
  }
  matrix_ = std::move(matrix);
}

int LinkCosts::NodeOf(int entry) const {
  return entry == start() ? rules_.start_node
                          : rules_.node_of[static_cast<size_t>(table_.path_of(entry))];
}

bool LinkCosts::Penalized(int from, int to) const {
  if (rules_.linked == nullptr || to == finish()) return false;
  const int a = NodeOf(from);
  const int b = NodeOf(to);
  return a >= 0 && b >= 0 && a != b && !rules_.linked->Linked(a, b);
}

double LinkCosts::Compute(int from, int to) const {
  if (to == finish() && !problem_.finish) return 0;
  const Point exit = from == start() ? problem_.start : table_.exit(from);
  const Point enter = to == finish() ? *problem_.finish : table_.enter(to);
  return travel_(exit, enter) + (Penalized(from, to) ? penalty_ : 0);
}

}  // namespace traverse
