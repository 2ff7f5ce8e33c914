// How LayerSolver keeps a job that looks ahead from becoming longer than one layer after the other.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "engine/base/rng.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/model/point.h"
#include "engine/schedule/layer_solver.h"

namespace traverse {
void LayerSolver::SolveAlone(ChainLayer& layer, Point start) const {
  const Stopwatch watch;
  const LayerProblem problem = Problem(layer, start);
  const TrueStart at{start, {}};
  const uint64_t key = KeyAt(layer, at);
  const KnownRoute* known =
      layer.anchored ? FindAnchored(layer, layer.anchored->alone, key) : nullptr;
  LayerAlone alone{.solution = {}, .start = start};
  if (layer.resumes_initial) {
    alone.solution.route = layer.given.initial_route;
  } else {
    alone.solution = ValidFromTrueStart(problem, layer, known, at);
  }
  Budget turns = Turns();
  if (turns.ExhaustedNow()) return;  // cancelled: nobody reads it
  alone.end = RouteEnd(layer.given.plan, alone.solution.route, start);
  alone.cost = RouteCost(problem, alone.solution.route, &turns);
  if (layer.anchored && !layer.resumes_initial) {
    alone.known = Known(problem, layer, alone.solution);
    layer.anchored->alone[key] = alone.known;
  }
  layer.alone = std::move(alone);
  layer.outcome.solve_seconds += watch.Seconds();
}

// Whether the layer and all in view are part of the chain that is solved one after the other.
bool LayerSolver::KnowsAlone(const ChainLayer& layer, const TrueStart& at) {
  return layer.alone && std::all_of(at.view.begin(), at.view.end(),
                                    [](const ChainLayerPtr& next) { return next->alone; });
}

// The cheapest way back from `route` to the layers done one after the other: some of the layers in
// view as they are foreseen, then a layer as it was found alone, or one that ends where it would
// end then. Unset if no layer in view is known to lead back.
std::optional<LayerSolver::Return> LayerSolver::CheapestReturn(const LayerProblem& problem,
                                                               const Route& route,
                                                               const ChainLayer& layer,
                                                               const TrueStart& at) const {
  std::optional<Return> cheapest;
  const auto offer = [&cheapest](double over, size_t foreseen, bool by_way_back = false) {
    if (!cheapest || over < cheapest->over) cheapest = Return{over, foreseen, by_way_back};
  };
  const bool is_length = problem.cost.kind == CostSpec::Kind::kLength;
  double over = at.over_alone + RouteCost(problem, route) - layer.alone->cost;
  Point end = EndOf(layer, route, problem.start);
  for (size_t i = 0;; ++i) {
    const ChainLayer& last = i == 0 ? layer : *at.view[i - 1];
    if (i == at.view.size() && at.end_is_free) offer(over, i);
    if (end == EndAlone(last)) offer(over, i);
    // Whatever follows costs no more from here than by way of there. Times can: of one retraction.
    if (is_length) offer(over + Distance(end, EndAlone(last)), i);
    if (i == at.view.size()) return cheapest;
    const ChainLayer& next = *at.view[i];
    const LayerProblem from = Problem(next, end);
    offer(over + RouteCost(from, next.alone->solution.route) - next.alone->cost, i);
    if (i + 1 == at.view.size() && !next.way_back.empty()) {
      const double gap = Distance(EndOf(next, next.way_back, end), EndAlone(next));
      if (gap == 0 || is_length)
        offer(over + RouteCost(from, next.way_back) - next.alone->cost + gap, i, true);
    }
    if (next.foreseen.empty()) return cheapest;
    over += RouteCost(from, next.foreseen) - next.alone->cost;
    end = EndOf(next, next.foreseen, end);
  }
}

// Whether a job that goes on by `route` need not become longer than one layer after the other.
bool LayerSolver::LeadsBack(const LayerProblem& problem, const Route& route,
                            const ChainLayer& layer, const TrueStart& at) const {
  const std::optional<Return> back = CheapestReturn(problem, route, layer, at);
  return back && back->over <= kSameCost * layer.alone->cost;
}

// Lets the last layer in view, from where those before it are foreseen to end, end where it does
// alone: that costs less than another end of all of them.
void LayerSolver::FindWayBack(const LayerProblem& problem, const Route& route, const TrueStart& at,
                              Budget& budget) const {
  Point end = RouteEnd(*problem.plan, route, problem.start);
  for (const ChainLayerPtr& next : at.view) {
    if (next != at.view.back()) {
      end = EndOf(*next, next->foreseen, end);
      continue;
    }
    LayerProblem from = Problem(*next, end);
    from.finish = EndAlone(*next);
    next->way_back = Prepared(*next).Resume(from, next->foreseen, budget).route;
  }
}

// Replaces a route that is not known to lead back without a loss by the one that is known to.
// Returns whether it did.
bool LayerSolver::KeepWithinAlone(const LayerProblem& problem, const ChainLayer& layer,
                                  const TrueStart& at, Solution& solution) const {
  const std::optional<Return> back = CheapestReturn(problem, solution.route, layer, at);
  if (back && back->over <= kSameCost * layer.alone->cost) {
    for (size_t i = 0; i < at.view.size(); ++i) {
      ChainLayer& next = *at.view[i];
      next.fallback.clear();
      if (i < back->foreseen) next.fallback = next.foreseen;
      if (i == back->foreseen && back->by_way_back) next.fallback = next.way_back;
    }
    return false;
  }
  const Route& fallback = FallbackRoute(layer);
  if (solution.route == fallback) return false;
  solution.route = fallback;
  if (solution.stop == StopReason::kOptimal) solution.stop = StopReason::kLocalOptimum;
  return true;
}

}  // namespace traverse
