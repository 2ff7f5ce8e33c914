// How LayerSolver ends a layer with the next ones in view.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/cost/route_cost.h"
#include "engine/schedule/layer_solver.h"

namespace traverse {
namespace {

// Of the time there is for the search in view, what its beginnings may use.
constexpr double kBeginningsShare = 0.4;

bool HasWalls(const ChainLayer& layer) { return !layer.given.walls.empty(); }

// Of `layer` and those behind it.
size_t PathsOf(const ChainLayer& layer, const LayersInView& view) {
  size_t paths = layer.given.plan.paths.size();
  for (const ChainLayerPtr& next : view) paths += next->given.plan.paths.size();
  return paths;
}

}  // namespace

Budget LayerSolver::Part(const Budget& budget, double share) {
  if (!budget.deadline()) return budget;
  const Budget::Clock::duration left = *budget.deadline() - Budget::Clock::now();
  return budget.Within(std::chrono::duration_cast<Budget::Clock::duration>(share * left));
}

size_t LayerSolver::MostPathsInView(const LayersInView& view) const {
  const StrategyTraits& traits = strategy_->traits();
  return view.empty() ? traits.look_ahead_paths : traits.look_further_paths;
}

bool LayerSolver::MayLookAhead(const ChainLayer& layer, const LayersInView& view) const {
  const ChainLayer& last = view.empty() ? layer : *view.back();
  const size_t paths = PathsOf(layer, view);
  if (!view.empty() && (HasWalls(layer) || HasWalls(last))) return false;
  return view.size() < kMostInView && last.given.more_follows && !CleaningDueAfter(last.index) &&
         paths > 0 && paths < MostPathsInView(view);
}

bool LayerSolver::LooksAheadAt(const ChainLayer& layer, const LayersInView& view,
                               const ChainLayer& next) const {
  if (FixedStart(next) || next.cost != layer.cost) return false;
  if (!view.empty() && HasWalls(next)) return false;
  const size_t paths = next.given.plan.paths.size();
  return paths > 0 && PathsOf(layer, view) + paths <= MostPathsInView(view);
}

double LayerSolver::CostInView(const LayerProblem& problem, const Route& route,
                               const LayersInView& view) const {
  Budget turns = Turns();
  const double cost = RouteCost(problem, route, &turns);
  if (view.empty()) return cost;
  const ChainLayer& next = *view.front();
  const Point end = RouteEnd(*problem.plan, route, problem.start);
  const Route& known = next.foreseen.empty() ? next.first.route : next.foreseen;
  return cost + RouteCost(Problem(next, end), known);
}

// Sets the starts of `next`, each where the layer before it ends, and the cost of all.
void LayerSolver::Connect(const LayerProblem& problem, RoutesInView& routes) {
  routes.cost = RouteCost(problem, routes.route);
  Point at = RouteEnd(*problem.plan, routes.route, problem.start);
  for (NextLayer& next : routes.next) {
    next.problem.start = at;
    routes.cost += RouteCost(next.problem, next.route);
    at = RouteEnd(*next.problem.plan, next.route, at);
  }
}

// Each layer solved from where the one before it ends, as without a view.
LayerSolver::RoutesInView LayerSolver::OneAfterTheOther(const LayerProblem& problem,
                                                        const Route& route,
                                                        const LayersInView& view,
                                                        Budget& budget) const {
  RoutesInView routes{route, {}, 0};
  Point at = RouteEnd(*problem.plan, route, problem.start);
  for (const ChainLayerPtr& next : view) {
    NextLayer& found = routes.next.emplace_back(NextLayer{Problem(*next, at), next->first.route});
    if (at != next->predicted_start) {
      found.route = Prepared(*next).Resume(found.problem, found.route, budget).route;
    }
    at = RouteEnd(*found.problem.plan, found.route, at);
  }
  Connect(problem, routes);
  return routes;
}

// What the layer before saw of this one and the next ones, as far as that goes, and the rest from
// there on.
LayerSolver::RoutesInView LayerSolver::AsForeseen(const LayerProblem& problem,
                                                  const ChainLayer& layer, const LayersInView& view,
                                                  Budget& budget) const {
  RoutesInView routes{layer.foreseen, {}, 0};
  Point at = RouteEnd(*problem.plan, layer.foreseen, problem.start);
  for (const ChainLayerPtr& next : view) {
    NextLayer& found = routes.next.emplace_back(NextLayer{Problem(*next, at), next->foreseen});
    if (next->foreseen.empty()) {
      found.route = Prepared(*next).Resume(found.problem, next->first.route, budget).route;
    }
    at = RouteEnd(*found.problem.plan, found.route, at);
  }
  Connect(problem, routes);
  return routes;
}

LayerSolver::RoutesInView LayerSolver::AsGreedyDoes(const LayerProblem& problem,
                                                    const ChainLayer& layer,
                                                    const LayersInView& view) const {
  RoutesInView routes{GreedyRoute(problem, layer), {}, 0};
  Point at = RouteEnd(*problem.plan, routes.route, problem.start);
  for (const ChainLayerPtr& next : view) {
    const LayerProblem follows = Problem(*next, at);
    routes.next.push_back({follows, GreedyRoute(follows, *next)});
    at = RouteEnd(*follows.plan, routes.next.back().route, at);
  }
  Connect(problem, routes);
  return routes;
}

// Ends the layer with the next ones in view. `solution` is of the layer alone. What is found is
// never longer, for all these layers together, than one after the other from there, or than what
// was foreseen, or than greedy.
void LayerSolver::SolveInView(const LayerProblem& problem, ChainLayer& layer,
                              const LayersInView& view, Budget& budget, Solution& solution) const {
  Budget beginnings = Part(budget, kBeginningsShare);
  RoutesInView best = OneAfterTheOther(problem, solution.route, view, beginnings);
  const auto offer = [&best](RoutesInView routes) {
    if (routes.cost < best.cost) best = std::move(routes);
  };
  if (!layer.foreseen.empty()) offer(AsForeseen(problem, layer, view, beginnings));
  offer(AsGreedyDoes(problem, layer, view));
  solution = Prepared(layer).ResumeWithNext(problem, best.route, best.next, budget);
  for (size_t i = 0; i < view.size(); ++i) view[i]->foreseen = std::move(best.next[i].route);
}

}  // namespace traverse
