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
namespace {

// For a route that was put in the place of one that was found: for the sake of the next layer, or
// the same but for rounding.
void StateReplaced(const LayerProblem& problem, Solution& solution) {
  if (solution.stop == StopReason::kOptimal &&
      RouteCost(problem, solution.route) > solution.lower_bound.value_or(0) * (1 + kSameCost)) {
    solution.stop = StopReason::kLocalOptimum;
  }
}

}  // namespace

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
  if (was_replaced) StateReplaced(problem, solution);
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
  StateReplaced(problem, solution);
  return true;
}

// A cheaper route may end where all that follows costs more, and the clock may cut short whatever
// would mend that. So wherever it may, the job can at each layer's end go on so that it costs no
// more in all than greedy's chain, by what is known then: by that chain, or first by the layers in
// view as they are foreseen. A layer whose route would break this keeps to what the one before
// foresaw of it, or to greedy's chain, from which it holds. Returns whether it does.
bool LayerSolver::KeepWithinGreedy(const LayerProblem& problem, const ChainLayer& layer,
                                   const TrueStart& at, Solution& solution) const {
  if (!layer.greedy || strategy_->traits().pure) return false;
  const auto over = [&](const Route& route) {
    return at.over_greedy + RouteCost(problem, route) - layer.greedy->cost +
           MostOverGreedyFrom(EndOf(layer, route, problem.start), layer, at);
  };
  double least = over(solution.route);
  if (least <= kSameCost * layer.greedy->cost) return false;
  const Route* best = nullptr;
  for (const Route* route : {&layer.foreseen, &layer.greedy->route}) {
    if (route->size() != solution.route.size()) continue;
    const double other = over(*route);
    if (other >= least) continue;
    least = other;
    best = route;
  }
  if (best == nullptr) return false;
  solution.route = *best;
  StateReplaced(problem, solution);
  return true;
}

// What the layers behind this one cost more from `end` than greedy's chain does, if they go on in
// the cheapest of the known ways.
double LayerSolver::MostOverGreedyFrom(Point end, const ChainLayer& layer,
                                       const TrueStart& at) const {
  const ChainLayer* before = &layer;
  const ChainLayer* next = at.next.get();
  bool is_followed = at.is_followed;
  double foreseen = 0;
  double least = MostOverGreedyFrom(end, *before, is_followed, next);
  for (size_t i = 0; i < at.view.size(); ++i) {
    before = at.view[i].get();
    if (!before->greedy || before->foreseen.size() != before->given.plan.paths.size()) break;
    foreseen += RouteCost(Problem(*before, end), before->foreseen) - before->greedy->cost;
    end = EndOf(*before, before->foreseen, end);
    next = i + 1 < at.view.size() ? at.view[i + 1].get() : nullptr;
    is_followed = next != nullptr || before->given.more_follows;
    least = std::min(least, foreseen + MostOverGreedyFrom(end, *before, is_followed, next));
  }
  return least;
}

// The same if they go on by greedy's chain, from where it ends `layer`. If they are not known, or
// their walls may not be asked about because the layer is being searched: at most. They go to that
// end first, or cross to where they begin.
double LayerSolver::MostOverGreedyFrom(Point end, const ChainLayer& layer, bool is_followed,
                                       const ChainLayer* next) const {
  if (!is_followed || end == layer.greedy->end) return 0;
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
