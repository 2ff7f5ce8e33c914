// How LayerSolver ends a layer with the next ones in view.

#include <algorithm>
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

// Each layer from where the one before it ends: the first one by `route`, those in view by
// route_of(layer, its problem).
template <typename RouteOf>
LayerSolver::RoutesInView LayerSolver::InView(const LayerProblem& problem, const Route& route,
                                              const TrueStart& at, const RouteOf& route_of) const {
  RoutesInView routes{route, {}, RouteCost(problem, route)};
  Point end = RouteEnd(*problem.plan, route, problem.start);
  for (const ChainLayerPtr& layer : at.view) {
    NextLayer& next = routes.next.emplace_back(NextLayer{Problem(*layer, end), {}});
    next.route = route_of(*layer, next.problem);
    routes.cost += RouteCost(next.problem, next.route);
    end = RouteEnd(*next.problem.plan, next.route, end);
  }
  return routes;
}

// The routes of the layer and those in view that are known before they are searched: `found` for
// the layer and the next ones as each is found from there, what the layer before foresaw, greedy's,
// the caller's with `initial`, and, where it is known, what each layer has alone.
std::vector<LayerSolver::RoutesInView> LayerSolver::KnownInView(const LayerProblem& problem,
                                                                const Route& found,
                                                                ChainLayer& layer,
                                                                const TrueStart& at, bool initial,
                                                                Budget& budget) const {
  Budget beginnings = budget.WithShare(kBeginningsShare);
  const auto alone = [&](ChainLayer& next, const LayerProblem& from) {
    const Solution* known = FoundFrom(next, from.start);
    if (known != nullptr) return known->route;
    return Prepared(next).Resume(from, next.first.route, beginnings).route;
  };
  const auto foreseen = [&](ChainLayer& next, const LayerProblem& from) {
    return next.foreseen.empty() ? alone(next, from) : next.foreseen;
  };
  const auto greedy = [&](const ChainLayer& next, const LayerProblem& from) {
    return GreedyRoute(from, next);
  };
  const auto of_caller = [&](const ChainLayer& next, const LayerProblem&) {
    return next.given.initial_route;
  };
  const auto fallback = [&](const ChainLayer& next, const LayerProblem&) {
    return FallbackRoute(next);
  };
  std::vector<RoutesInView> known = {InView(problem, found, at, alone)};
  if (!layer.foreseen.empty()) known.push_back(InView(problem, layer.foreseen, at, foreseen));
  known.push_back(InView(problem, GreedyRoute(problem, layer), at, greedy));
  if (initial) known.push_back(InView(problem, layer.given.initial_route, at, of_caller));
  if (KnowsAlone(layer, at)) {
    known.push_back(InView(problem, FallbackRoute(layer), at, fallback));
  }
  return known;
}

// Ends the layer with the next ones in view. `solution` is of the layer alone. What is found is
// never longer, for all these layers together, than one after the other from there, or than what
// the layer before foresaw of them, or than greedy.
void LayerSolver::SolveInView(const LayerProblem& problem, ChainLayer& layer, const TrueStart& at,
                              Budget& budget, Solution& solution) const {
  // Routes of a caller that are as good as a search makes them were probably found with the next
  // layers in view; others that the caller knows need little mending.
  const auto of_all = [&](bool ChainLayer::*is) {
    return layer.*is && std::all_of(at.view.begin(), at.view.end(),
                                    [is](const ChainLayerPtr& next) { return (*next).*is; });
  };
  const bool holds = of_all(&ChainLayer::initial_holds);
  LayerProblem searched = problem;
  searched.is_searched = of_all(&ChainLayer::resumes_initial);
  std::vector<RoutesInView> known =
      KnownInView(problem, solution.route, layer, at, searched.is_searched, budget);
  const auto search_from = [&](RoutesInView best) {
    if (holds) {
      if (best.route != solution.route && solution.stop == StopReason::kOptimal)
        solution.stop = StopReason::kLocalOptimum;
      solution.route = std::move(best.route);
    } else {
      solution = Prepared(layer).ResumeWithNext(searched, best.route, best.next, budget);
    }
    for (size_t i = 0; i < at.view.size(); ++i)
      at.view[i]->foreseen = std::move(best.next[i].route);
  };
  const auto costs_less = [](const RoutesInView& a, const RoutesInView& b) {
    return a.cost < b.cost;
  };
  search_from(*std::min_element(known.begin(), known.end(), costs_less));
  const ChainLayer& last = *at.view.back();
  if (!KnowsAlone(layer, at) || LeadsBack(problem, solution.route, layer, at) || HasWalls(last))
    return;
  FindWayBack(problem, solution.route, at, budget);
  if (LeadsBack(problem, solution.route, layer, at)) return;
  // Again, with the way back from the last layer.
  for (RoutesInView& routes : known) {
    LayerProblem& problem_of_last = routes.next.back().problem;
    routes.cost -= RouteCost(problem_of_last, routes.next.back().route);
    problem_of_last.finish = EndAlone(last);
    routes.cost += RouteCost(problem_of_last, routes.next.back().route);
  }
  search_from(*std::min_element(known.begin(), known.end(), costs_less));
}

}  // namespace traverse
