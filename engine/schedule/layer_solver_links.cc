// How LayerSolver answers a layer whose links cost more than their moves. The stages search a
// problem without links, whose cost is the same in both directions. What they find is measured and
// improved by its true cost here, last.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "engine/base/tolerances.h"
#include "engine/cost/link_cost.h"
#include "engine/cost/route_cost.h"
#include "engine/proof/bounds/lower_bound.h"
#include "engine/proof/linked_optimum.h"
#include "engine/schedule/layer_solver.h"
#include "engine/search/link_search.h"

namespace traverse {
namespace {

// Costs of links that an optimum may take, of 25 ns: some seconds where callers ask for a proof,
// and as long as the search of a small layer beside another search.
constexpr int64_t kMostLinksOfProof = 200'000'000;
constexpr int64_t kMostLinksBesideSearch = 500'000;

}  // namespace

LayerProblem LayerSolver::LinkedProblem(const ChainLayer& layer, const Departure& before) const {
  LayerProblem problem = Problem(layer, *before.from);
  problem.cost = TrueCost(layer);
  if (layer.linked_walls) problem.walls = layer.linked_walls.get();
  problem.links = &layer.given.links;
  problem.before = before;
  return problem;
}

// The cheapest of the known routes, made cheaper. A pure method's own route stays, and so does that
// of one that does not search, unless the caller knows a better one.
void LayerSolver::ImproveLinked(const LayerProblem& linked, const ChainLayer& layer,
                                Solution& solution) const {
  Budget turns = Turns();
  double least = RouteCost(linked, solution.route, &turns);
  const auto offer = [&](const Route& route) {
    if (route.size() != solution.route.size()) return;  // there is none
    const double cost = RouteCost(linked, route, &turns);
    if (cost >= least) return;
    least = cost;
    solution.route = route;
  };
  offer(layer.given.initial_route);
  if (strategy_->traits().pure || !strategy_->traits().searches) return;
  offer(layer.given_route);
  if (layer.greedy) offer(layer.greedy->route);
  if (Expired(layer)) return;
  Budget budget = LayerBudget(layer, AnchorShare());
  const LinkEffort effort = strategy_->traits().quick ? LinkEffort::kSettle : LinkEffort::kKick;
  solution.route = ImproveLinks(linked, solution.route, effort, budget);
}

// Of a small layer: the best route, with which the solution agrees then.
bool LayerSolver::ProveLinked(const LayerProblem& linked, const ChainLayer& layer,
                              Solution& solution) const {
  Budget budget = LayerBudget(layer, AnchorShare());
  const int64_t most = strategy_->traits().serial ? kMostLinksOfProof : kMostLinksBesideSearch;
  std::optional<Route> optimum = LinkedOptimum(linked, most, budget);
  if (!optimum) return false;
  Budget turns = Turns();
  const double cost = RouteCost(linked, solution.route, &turns);
  if (RouteCost(linked, *optimum, &turns) < cost - kImprovementTolerance) {
    solution.route = *std::move(optimum);
  }
  solution.stop = StopReason::kOptimal;
  solution.lower_bound = RouteCost(linked, solution.route, &turns);
  return true;
}

// What the searches proved holds only where they knew all. Otherwise the bound is that of a problem
// whose links cost least.
void LayerSolver::BoundLinked(const LayerProblem& linked, const ChainLayer& layer,
                              Solution& solution) const {
  const StrategyTraits& traits = strategy_->traits();
  const bool wanted = solution.lower_bound || traits.bound_effort > 0;
  const bool has_time = wanted && !Expired(layer);
  if (has_time && traits.searches && !traits.pure && ProveLinked(linked, layer, solution)) return;
  const LeastLinks least = LeastOf(linked);
  Budget turns = Turns();
  const double cost = RouteCost(linked, solution.route, &turns);
  const bool even = !least.moved && least.cost == layer.cost;
  if (!even) solution.lower_bound.reset();
  if (!even && has_time) {
    LayerProblem bare = linked;
    bare.cost = least.cost;
    bare.links = nullptr;
    bare.walls = nullptr;
    Budget budget = LayerBudget(layer, AnchorShare());
    const double effort = std::max(1.0, traits.bound_effort);
    solution.lower_bound =
        LowerBound(bare, RouteCost(bare, solution.route, &turns), nullptr, effort, budget);
  }
  if (solution.lower_bound) {
    *solution.lower_bound = std::clamp(*solution.lower_bound + least.seconds, 0.0, cost);
  }
  const bool proven = solution.lower_bound && cost <= *solution.lower_bound * (1 + kSameCost);
  if (proven) solution.stop = StopReason::kOptimal;
  if (!proven && solution.stop == StopReason::kOptimal) solution.stop = StopReason::kLocalOptimum;
}

}  // namespace traverse
