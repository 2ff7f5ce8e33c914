// How LayerSolver keeps every layer from costing more than greedy's route, and than the one that
// the caller knows, also when time is up.

#include <algorithm>
#include <cstddef>
#include <optional>

#include "absl/time/time.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/travel_cost.h"
#include "engine/schedule/layer_solver.h"

namespace traverse {

Route LayerSolver::GreedyRoute(const LayerProblem& problem, const ChainLayer& layer) const {
  if (layer.greedy && layer.greedy->start == problem.start) return layer.greedy->route;
  const int64_t points = SizeOf(*problem.plan).points;
  const bool may_be_late = points <= late_points_left_;
  Budget budget(&cancel_, may_be_late ? std::nullopt : layer.greedy_end, executor_.turn(),
                spec_.time);
  Route route = predictor_->Solve(problem, budget).route;
  const bool is_late = spec_.deadline && Budget::Now(spec_.time) >= *spec_.deadline;
  if (is_late && may_be_late) late_points_left_ -= points;
  return route;
}

bool LayerSolver::ResumesInitial(const LayerProblem& problem, const ChainLayer& layer) const {
  const Route& initial = layer.given.initial_route;
  if (initial.empty() || !strategy_->traits().searches) return !initial.empty();
  Budget turns = Turns();
  const double cost = RouteCost(problem, initial, &turns);
  // Of greedy's chain, if there is one: no time is kept for another route.
  const Route greedy = layer.greedy ? layer.greedy->route : GreedyRoute(problem, layer);
  return cost <= RouteCost(problem, greedy, &turns);
}

bool LayerSolver::MayBeCutShort() const {
  const bool limited = spec_.deadline || spec_.layer_time_limit != absl::InfiniteDuration();
  return limited && strategy_->traits().searches && !strategy_->traits().pure;
}

// Other routes may be better from the true start: an equal layer's from the same start; what the
// layer before saw ahead; those found for another start, where the clock cut the last search short;
// greedy's, which a resumed route need not beat; the order given; the route that the caller knows.
// All with the next layers in view: for their sake a layer's own travel may grow.
void LayerSolver::KeepBestRoute(const LayerProblem& problem, const ChainLayer& layer,
                                const KnownRoute* known, const LayersInView& view,
                                Solution& solution) const {
  double best = CostInView(problem, solution.route, view);
  bool was_replaced = false;
  const auto offer = [&](const Route& route) {
    if (route.size() != solution.route.size()) return;  // there was no such search
    const double cost = CostInView(problem, route, view);
    if (cost >= best) return;
    best = cost;
    solution.route = route;
    was_replaced = true;
  };
  if (known != nullptr) offer(known->solution.route);
  offer(layer.foreseen);
  if (GreedyMayBeBetter(problem, layer, known, solution)) {
    // Of a large layer, for which there is no time to look again, at least that.
    if (layer.greedy) offer(layer.greedy->route);
    offer(GreedyRoute(problem, layer));
  }
  if (solution.stop == StopReason::kTimeLimit) {
    offer(layer.first.route);
    offer(layer.second.route);
  }
  offer(layer.given_route);
  offer(layer.given.initial_route);
  // An optimal route was replaced for the sake of the next layer, or by one that is the same but
  // for rounding.
  if (was_replaced && solution.stop == StopReason::kOptimal &&
      RouteCost(problem, solution.route) > solution.lower_bound.value_or(0) * (1 + kSameCost)) {
    solution.stop = StopReason::kLocalOptimum;
  }
}

// A layer's own cost never exceeds that of the route that the caller knows, not even for the sake
// of the next layers, and whatever the strategy. Returns whether that route is now the answer.
bool LayerSolver::KeepWithinInitial(const LayerProblem& problem, const ChainLayer& layer,
                                    Solution& solution) const {
  const Route& initial = layer.given.initial_route;
  if (initial.empty()) return false;
  Budget turns = Turns();
  const double cost = RouteCost(problem, initial, &turns);
  if (cost >= RouteCost(problem, solution.route, &turns)) return false;
  solution.route = initial;
  if (cost > solution.lower_bound.value_or(0) * (1 + kSameCost) &&
      solution.stop == StopReason::kOptimal) {
    solution.stop = StopReason::kLocalOptimum;
  }
  return true;
}

// A cheaper route may end where all that follows costs more. So where the clock cut a search short,
// the job must be able to go on by greedy's chain from the next layer on, also if that has not come
// yet, and cost no more than that in all; if not, the layer keeps to greedy's chain, from which it
// can. Returns whether it does.
bool LayerSolver::KeepWithinGreedy(const LayerProblem& problem, const ChainLayer& layer,
                                   const TrueStart& at, Solution& solution) const {
  const bool knows = layer.greedy && layer.greedy->route.size() == solution.route.size();
  if (!knows || solution.stop != StopReason::kTimeLimit || strategy_->traits().pure) return false;
  const auto over = [&](const Route& route) {
    const Point end = layer.finish.value_or(RouteEnd(layer.given.plan, route, problem.start));
    return at.over_greedy + RouteCost(problem, route) - layer.greedy->cost +
           MostOverGreedyFrom(end, layer, at);
  };
  const double of_solution = over(solution.route);
  const double same = kSameCost * layer.greedy->cost;
  if (of_solution <= same || over(layer.greedy->route) >= of_solution) return false;
  solution.route = layer.greedy->route;
  return true;
}

// What the layers behind this one cost more from `end` than from where greedy's chain ends it, if
// they go on by that chain. If they are not known, or their walls may not be asked about because
// the layer is being searched: at most. They go to that end first, or cross to where they begin.
double LayerSolver::MostOverGreedyFrom(Point end, const ChainLayer& layer,
                                       const TrueStart& at) const {
  if (!at.is_followed || end == layer.greedy->end) return 0;
  const ChainLayer* const next = at.next.get();
  if (next != nullptr && next->greedy && !next->walls)
    return RouteCost(Problem(*next, end), next->greedy->route) - next->greedy->cost;
  const CostSpec& cost = next != nullptr ? next->cost : layer.cost;
  const double length_mm = Distance(end, layer.greedy->end);
  if (cost.kind == CostSpec::Kind::kLength) return length_mm;
  return TravelCost(cost).Motion(length_mm) + cost.retraction_seconds + cost.lift_seconds +
         cost.crossing_seconds;
}

// Whether greedy's route may still be better: it cannot be if the strategy began at this very
// start, and ended by itself, or if an equal layer's route was taken over.
bool LayerSolver::GreedyMayBeBetter(const LayerProblem& problem, const ChainLayer& layer,
                                    const KnownRoute* known, const Solution& solution) const {
  if (solution.stop == StopReason::kTimeLimit) return true;
  if (strategy_->traits().serial || strategy_->traits().quick) return false;
  const bool is_compared =
      known != nullptr && known->exact == layer.fingerprint.exact && known->start == problem.start;
  return !is_compared && (layer.precursor || problem.start != layer.predicted_start);
}

}  // namespace traverse
