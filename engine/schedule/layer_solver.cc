#include "engine/schedule/layer_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "engine/base/rng.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/travel_cost.h"
#include "engine/schedule/layer_outcome.h"
#include "engine/strategy/greedy.h"
#include "engine/validator.h"

namespace traverse {
namespace {

// The most and the least share of a layer's time limit for anchor. Anchor knows the true start, but
// runs one layer after another, so many threads would wait for it.
constexpr double kMostAnchorShare = 0.5;
constexpr double kLeastAnchorShare = 0.1;
constexpr double kThreadsWorthOfAnchor = 0.8;

// The share of that for the layer alone, if the search then goes on with the next ones in view.
constexpr double kAloneShare = 0.4;

// The share for predicting an end or comparing with greedy, and for a search for a bound.
constexpr double kSideShare = 0.15;

// A bound of the chain is asked for by name: worth more than that which comes with each route.
constexpr double kLeastEffortOfChainBound = 2;

// Lengths of moves may differ by this between layers of one problem key: the ends are equal to 1e-4
// mm in each direction, relative to origins that are equal to 1e-4 mm.
constexpr double kSameMoveMm = 6e-4;

}  // namespace

LayerSolver::LayerSolver(const JobSpec& spec, std::unique_ptr<Strategy> strategy,
                         Executor& executor, const CancelToken& cancel)
    : spec_(spec),
      strategy_(std::move(strategy)),
      predictor_(GreedyEntry().make(*StrategyOptions::Parse(GreedyEntry().options, {}))),
      executor_(executor),
      cancel_(cancel) {}

// Until `end`, and no longer than `share` of the smaller of a part of the job's time and so many
// times the limit of one layer.
Budget LayerSolver::BudgetWithin(std::optional<Budget::Clock::time_point> end,
                                 Budget::Clock::duration allotted, double layer_limits,
                                 double share) const {
  using Duration = Budget::Clock::duration;
  const Budget whole(&cancel_, end, executor_.turn(), spec_.time);
  const absl::Duration layers = layer_limits * spec_.layer_time_limit;
  if (layers != absl::InfiniteDuration()) {
    allotted =
        std::min(allotted, std::chrono::duration_cast<Duration>(absl::ToChronoNanoseconds(layers)));
  }
  if (allotted == Duration::max()) return whole;
  return whole.Within(std::chrono::duration_cast<Duration>(share * allotted));
}

Budget LayerSolver::LayerBudget(const ChainLayer& layer, double share) const {
  return BudgetWithin(layer.search_end, layer.allotted, 1, share);
}

double LayerSolver::AnchorShare() const {
  return std::clamp(kThreadsWorthOfAnchor / std::max(1, executor_.threads()), kLeastAnchorShare,
                    kMostAnchorShare);
}

// Whether anchor has nothing to do: the start is certain and the next layer is not in view.
double LayerSolver::SolveShare(const ChainLayer& layer) const {
  return FixedStart(layer) && !MayLookAhead(layer, {}) ? 1 : 1 - AnchorShare();
}

bool LayerSolver::Expired(const ChainLayer& layer) const {
  return Budget(&cancel_, layer.search_end, nullptr, spec_.time).ExhaustedNow();
}

LayerProblem LayerSolver::Problem(const ChainLayer& layer, Point start) const {
  LayerProblem problem{&layer.given.plan, start, layer.finish, layer.cost,
                       StreamSeed(spec_.seed, layer.index)};
  problem.walls = layer.walls.get();
  return problem;
}

bool LayerSolver::CleaningDueAfter(uint64_t index) const {
  if (!spec_.cleaning) return false;
  const uint64_t done = static_cast<uint64_t>(spec_.cleaning->layers_since_cleaning) + index + 1;
  return done % static_cast<uint64_t>(spec_.cleaning->every_layers) == 0;
}

// The start if it does not depend on the layer before.
std::optional<Point> LayerSolver::FixedStart(const ChainLayer& layer) const {
  if (layer.given.start) return layer.given.start;
  if (layer.index == 0) return spec_.start;
  if (CleaningDueAfter(layer.index - 1)) return spec_.cleaning->point;
  return std::nullopt;
}

void LayerSolver::SolveFirst(ChainLayer& layer) const {
  const Stopwatch watch;
  if (Expired(layer)) {
    const Route& known = layer.resumes_initial ? layer.given.initial_route : layer.given_route;
    layer.first = Solution{known, StopReason::kTimeLimit, std::nullopt};
    return;
  }
  Budget budget = LayerBudget(layer, SolveShare(layer));
  const LayerProblem problem = Problem(layer, layer.predicted_start);
  if (RouteOfPrecursor(problem, layer, budget) != nullptr) {
    ResumeFromPrecursor(problem, layer, budget);
  } else {
    layer.first = SolveOrResume(problem, layer, budget);
  }
  layer.initial_holds =
      layer.resumes_initial && layer.first.stop != StopReason::kTimeLimit &&
      RouteCost(problem, layer.first.route, &budget) >=
          RouteCost(problem, layer.given.initial_route, &budget) * (1 - kSameCost);
  if (!layer.first.lower_bound) Bound(problem, layer, layer.first);
  layer.outcome.solve_seconds = watch.Seconds();
}

// Solves the layer, or improves the route that the caller knows.
Solution LayerSolver::SolveOrResume(const LayerProblem& problem, ChainLayer& layer,
                                    Budget& budget) const {
  if (!layer.resumes_initial) return Prepared(layer).Solve(problem, budget);
  return Prepared(layer).Resume(problem, layer.given.initial_route, budget);
}

// The best route of an equal layer, if there is one; null also if the caller knows a better one.
const Route* LayerSolver::RouteOfPrecursor(const LayerProblem& problem, const ChainLayer& layer,
                                           Budget& budget) const {
  if (!layer.precursor) return nullptr;
  const Route& route = layer.precursor->best->solution.route;
  // It is extremely unlikely, but possible, that different layers share a fingerprint.
  if (!ValidateRoute(layer.given.plan, route, &budget).ok()) return nullptr;
  const bool worse =
      layer.resumes_initial && RouteCost(problem, layer.given.initial_route, &budget) <
                                   RouteCost(problem, route, &budget) * (1 - kSameCost);
  return worse ? nullptr : &route;
}

// Continues from the route of an equal layer, unless earlier searches from it gained nothing.
void LayerSolver::ResumeFromPrecursor(const LayerProblem& problem, ChainLayer& layer,
                                      Budget& budget) const {
  const PendingRoute& precursor = *layer.precursor;
  layer.bound_multipliers = precursor.best->multipliers;
  const bool same = precursor.key == layer.key;
  if (same && precursor.idle >= RouteHistory::kMostIdle &&
      TakeOver(*precursor.best, problem, layer, layer.first)) {
    return;
  }
  const Route& route = precursor.best->solution.route;
  layer.first = Prepared(layer).Resume(problem, route, budget);
  const bool gained = RouteCost(problem, layer.first.route, &budget) <
                      RouteCost(problem, route, &budget) * (1 - kSameCost);
  layer.searched_in_vain = same && !gained && layer.first.stop != StopReason::kTimeLimit;
  // Its bound too: another one would take longer than the search.
  if (layer.searched_in_vain && std::isfinite(strategy_->traits().bound_of_search))
    TakeOver(*precursor.best, problem, layer, layer.first);
}

// Answers with the route of a layer of the same problem key, if what is known about that route
// holds here too.
bool LayerSolver::TakeOver(const KnownRoute& known, const LayerProblem& problem,
                           const ChainLayer& layer, Solution& solution) const {
  const bool very_same = known.exact == layer.fingerprint.exact && known.start == problem.start &&
                         known.finish == problem.finish;
  if (!very_same && known.solution.stop != StopReason::kLocalOptimum) return false;
  if (known.solution.stop == StopReason::kTimeLimit) return false;
  solution.route = known.solution.route;
  solution.stop = known.solution.stop;
  solution.lower_bound = known.solution.lower_bound;
  if (!solution.lower_bound || very_same) return true;
  if (layer.cost.kind == CostSpec::Kind::kLength) {
    *solution.lower_bound -= kSameMoveMm * static_cast<double>(solution.route.size() + 1);
  } else {
    solution.lower_bound.reset();
  }
  return true;
}

KnownRoutePtr LayerSolver::Known(const LayerProblem& problem, const ChainLayer& layer,
                                 const Solution& solution) const {
  auto known = std::make_shared<KnownRoute>();
  known->solution = solution;
  Budget turns = Turns();
  known->cost = RouteCost(problem, solution.route, &turns);
  known->exact = layer.fingerprint.exact;
  known->start = problem.start;
  known->finish = problem.finish;
  known->multipliers = layer.bound_multipliers;
  return known;
}

const KnownRoute* LayerSolver::FindAnchored(const ChainLayer& layer,
                                            const AnchoredRoutes::ByKey& routes,
                                            uint64_t key) const {
  const auto found = routes.find(key);
  if (found == routes.end()) return nullptr;
  Budget turns = Turns();
  const bool fits = ValidateRoute(layer.given.plan, found->second->solution.route, &turns).ok();
  return fits ? found->second.get() : nullptr;
}

void LayerSolver::SolveSecond(ChainLayer& layer) const {
  const Stopwatch watch;
  if (Expired(layer)) {
    layer.second = layer.first;
    layer.second.stop = StopReason::kTimeLimit;
    return;
  }
  Budget budget = LayerBudget(layer, SolveShare(layer));
  layer.second = SolveOrResume(Problem(layer, *layer.second_start), layer, budget);
  layer.outcome.solve_seconds += watch.Seconds();
}

// The route of an equal layer from the same start may be better than the one found from a predicted
// start, and so may the one that the layer before found ahead.
const Route& LayerSolver::BestToGoOnFrom(const LayerProblem& problem, const ChainLayer& layer,
                                         const KnownRoute* known) const {
  const Route* best = &layer.first.route;
  double least = RouteCost(problem, *best);
  const auto offer = [&](const Route& route) {
    const double cost = RouteCost(problem, route);
    if (cost >= least) return;
    least = cost;
    best = &route;
  };
  if (known != nullptr) offer(known->solution.route);
  if (!layer.foreseen.empty()) offer(layer.foreseen);
  if (layer.alone) offer(FallbackRoute(layer));
  if (layer.resumes_initial) offer(layer.given.initial_route);
  return *best;
}

// What was found for the layer alone from that start, if anything.
const Solution* LayerSolver::FoundFrom(const ChainLayer& layer, Point start) {
  const bool is_alone = layer.alone && start == layer.alone->start;
  if (is_alone && !layer.resumes_initial) return &layer.alone->solution;
  return start == layer.predicted_start ? &layer.first : nullptr;
}

// For alone, if that is still to come, and for anchor.
Budget LayerSolver::BudgetFromTrueStart(const ChainLayer& layer) const {
  double share = AnchorShare();
  if (layer.carries_alone && !layer.alone) share *= kAloneShare;
  if (layer.alone && layer.alone->start != layer.predicted_start) share *= 1 - kAloneShare;
  return LayerBudget(layer, share);
}

Solution LayerSolver::SolveFromTrueStart(const LayerProblem& problem, ChainLayer& layer,
                                         const KnownRoute* known, const TrueStart& at) const {
  if (strategy_->traits().serial) {
    Budget budget = LayerBudget(layer, 1);
    return SolveOrResume(problem, layer, budget);
  }
  if (layer.second_start && problem.start == *layer.second_start) return layer.second;
  const LayersInView& view = at.view;
  const Solution* found = FoundFrom(layer, problem.start);
  // Without a next layer, the time meant for looking ahead is used for the layer itself: by anchor,
  // not before it for the layer alone.
  const bool for_alone = layer.carries_alone && !layer.alone;
  const bool has_time_left =
      layer.first.stop == StopReason::kTimeLimit && MayLookAhead(layer, {}) && !for_alone;
  if (found != nullptr && view.empty() && !has_time_left) return *found;
  Solution solution;
  if (known != nullptr && TakeOver(*known, problem, layer, solution)) return solution;
  if (Expired(layer)) {
    solution = found != nullptr ? *found : layer.first;
    solution.stop = StopReason::kTimeLimit;
    if (found == nullptr) solution.lower_bound.reset();  // it held for another start
    return solution;
  }
  Budget budget = BudgetFromTrueStart(layer);
  if (found != nullptr && !view.empty()) {
    solution = *found;
  } else {
    Budget alone = view.empty() ? budget : budget.WithShare(kAloneShare);
    const Route& from = BestToGoOnFrom(problem, layer, known);
    solution = strategy_->traits().quick ? SolveOrResume(problem, layer, alone)
                                         : Prepared(layer).Resume(problem, from, alone);
  }
  if (!view.empty()) SolveInView(problem, layer, at, budget, solution);
  if (found != nullptr && !solution.lower_bound) solution.lower_bound = found->lower_bound;
  // Statistics that resuming does not report stay as they were.
  solution.statistics.insert(layer.first.statistics.begin(), layer.first.statistics.end());
  // A search that the clock cut short still counts as cut short after polishing.
  if (layer.first.stop == StopReason::kTimeLimit) solution.stop = StopReason::kTimeLimit;
  return solution;
}

// Adds a lower bound to a solution if the strategy provides one. It is computed with the first
// solution, in parallel, or was computed for an equal layer; other starts reuse the result.
void LayerSolver::Bound(const LayerProblem& problem, ChainLayer& layer, Solution& solution) const {
  const double effort = strategy_->traits().bound_effort;
  if (effort == 0 || cancel_.cancelled()) return;
  Budget budget = LayerBudget(layer, kSideShare);
  const double cost = RouteCost(problem, solution.route, &budget);
  const double of_search = strategy_->traits().bound_of_search;
  const double most_seconds =
      std::isfinite(of_search) ? of_search * solution.counted_seconds : of_search;
  solution.lower_bound =
      LowerBound(problem, cost, &layer.bound_multipliers, effort, budget, most_seconds);
  if (solution.lower_bound == cost) solution.stop = StopReason::kOptimal;
}

std::optional<double> LayerSolver::BoundChain(const ChainBound& chain, uint64_t layers,
                                              Budget::Clock::duration allotted) const {
  const StrategyTraits& traits = strategy_->traits();
  const double effort = std::max(traits.bound_effort, kLeastEffortOfChainBound);
  const bool resumes = traits.chain_bounding == StrategyTraits::ChainBounding::kByResume;
  const auto bound_of = [&](const LayerProblem& problem, const Route& known, Budget& budget) {
    if (resumes) return strategy_->Resume(problem, known, budget).lower_bound;
    const double cost = RouteCost(problem, known, &budget);
    return LowerBound(problem, cost, nullptr, effort, budget);
  };
  Budget budget = BudgetWithin(spec_.deadline, allotted, static_cast<double>(layers), 1);
  return chain.Compute(spec_.seed, bound_of, budget);
}

// Everything the layer's route depends on, so that equal layers share it.
uint64_t LayerSolver::KeyAt(const ChainLayer& layer, const TrueStart& at) const {
  uint64_t key = ProblemKey(layer.fingerprint.shape, layer.origin, at.start, layer.finish);
  for (const ChainLayerPtr& next : at.view) {
    key = ProblemKeyBefore(key, layer.origin, next->fingerprint.shape, next->origin, next->finish);
  }
  return key;
}

// With the order given in the place of an invalid route, of which the outcome tells.
Solution LayerSolver::ValidFromTrueStart(const LayerProblem& problem, ChainLayer& layer,
                                         const KnownRoute* known, const TrueStart& at) const {
  Solution solution = SolveFromTrueStart(problem, layer, known, at);
  Budget turns = Turns();
  if (turns.ExhaustedNow()) return solution;  // cancelled: nobody reads it
  if (absl::Status status = ValidateRoute(layer.given.plan, solution.route, &turns); !status.ok()) {
    layer.outcome.invalid_route = std::string(status.message());
    return Solution{layer.given_route, StopReason::kLocalOptimum, std::nullopt};
  }
  // Of those in view too little is known once no time is left to search them.
  const LayersInView& view = Expired(layer) ? LayersInView() : at.view;
  if (!strategy_->traits().pure) KeepBestRoute(problem, layer, known, view, solution);
  return solution;
}

LayerOutcome LayerSolver::Anchor(ChainLayer& layer, const TrueStart& at) const {
  const Stopwatch watch;
  const LayerProblem problem = Problem(layer, at.start);
  const uint64_t key = KeyAt(layer, at);
  const KnownRoute* known =
      layer.anchored ? FindAnchored(layer, layer.anchored->anchored, key) : nullptr;
  Budget turns = Turns();
  for (Route* route : {&layer.foreseen, &layer.fallback})
    if (!ValidateRoute(layer.given.plan, *route, &turns).ok()) route->clear();
  for (const ChainLayerPtr& next : at.view) next->way_back.clear();
  Solution solution = ValidFromTrueStart(problem, layer, known, at);
  bool was_replaced = !turns.ExhaustedNow() && KnowsAlone(layer, at) &&
                      KeepWithinAlone(problem, layer, at, solution);
  was_replaced = KeepWithinGreedy(problem, layer, at, solution) || was_replaced;
  was_replaced = KeepWithinInitial(problem, layer, solution) || was_replaced;
  LayerOutcome outcome = std::move(layer.outcome);
  if (turns.ExhaustedNow()) return outcome;  // cancelled: nobody reads it
  if (!solution.lower_bound) Bound(problem, layer, solution);
  if (layer.anchored) {
    layer.known = Known(problem, layer, solution);
    // Equal layers need not be kept within what this one was.
    if (!was_replaced) layer.anchored->anchored[key] = layer.known;
  }
  if (turns.ExhaustedNow()) return outcome;
  if (!IsLinked(layer, at.departure)) {
    TellFound(problem, std::move(solution), layer.given, turns, outcome);
  } else {
    const LayerProblem linked = LinkedProblem(layer, {at.start, at.departure});
    ImproveLinked(linked, layer, solution);
    BoundLinked(linked, layer, solution);
    TellFound(linked, std::move(solution), layer.given, turns, outcome);
  }
  layer.prepared.reset();
  layer.walls.reset();
  layer.linked_walls.reset();
  outcome.solve_seconds += watch.Seconds();
  return outcome;
}

}  // namespace traverse
