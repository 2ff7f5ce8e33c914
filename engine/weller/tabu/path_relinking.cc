#include "engine/weller/tabu/path_relinking.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

#include "engine/validator.h"
#include "engine/weller/tabu/swap_sequence.h"

namespace traverse {
namespace {

// The cheapest swap that puts a child where the guide has it; node -1 if all are there.
SwapMove BestStep(const SwapSequence& sequence, int node, const std::vector<int>& guide,
                  Budget& budget) {
  const SequenceTree& tree = sequence.tree();
  SwapMove best;
  for (int target = 0; target < static_cast<int>(guide.size()); ++target) {
    if (budget.Exhausted()) break;
    const int at = tree.position_of(guide[static_cast<size_t>(target)]);
    if (at == target) continue;
    const SwapMove move = sequence.Evaluate(node, std::min(at, target), std::max(at, target));
    if (best.node < 0 || move.delta < best.delta) best = move;
  }
  return best;
}

}  // namespace

std::vector<Route> RelinkPaths(const LayerProblem& problem, const LinkRules& rules,
                               const Route& from, const Route& guide, int keep, Budget& budget) {
  assert(ValidateRoute(*problem.plan, from).ok() && ValidateRoute(*problem.plan, guide).ok());
  if (keep <= 0) return {};
  SwapSequence sequence(problem, rules, &budget);
  if (sequence.tree().movable_nodes().empty()) return {};
  const int node = sequence.tree().movable_nodes().front();
  assert(sequence.tree().movable_nodes().size() == 1);
  sequence.Load(guide);
  std::vector<int> guide_order;  // children by number
  for (int k = 0; k < sequence.tree().child_count(node); ++k) {
    guide_order.push_back(sequence.tree().child_at(node, k));
  }
  const std::vector<int> guide_paths = sequence.tree().Paths();
  sequence.Load(from);

  std::vector<std::pair<double, Route>> kept;  // by cost
  while (!budget.Exhausted()) {
    const SwapMove move = BestStep(sequence, node, guide_order, budget);
    if (move.node < 0) break;
    sequence.Apply(move);
    if (sequence.tree().Paths() == guide_paths) break;
    if (static_cast<int>(kept.size()) == keep && sequence.cost() >= kept.back().first) continue;
    const auto place = std::find_if(
        kept.begin(), kept.end(), [&](const auto& other) { return sequence.cost() < other.first; });
    kept.emplace(place, sequence.cost(), sequence.Unload());
    if (static_cast<int>(kept.size()) > keep) kept.pop_back();
  }
  std::vector<Route> routes;
  for (auto& [cost, route] : kept) routes.push_back(std::move(route));
  return routes;
}

}  // namespace traverse
