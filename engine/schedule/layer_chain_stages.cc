// What is done with one layer at a time; layer_chain.cc says when.

#include <algorithm>
#include <limits>
#include <utility>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "engine/base/rng.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/travel_cost.h"
#include "engine/schedule/layer_chain.h"
#include "engine/validator.h"

namespace traverse {
namespace {

// Of a layer's time limit, what anchor may use at most and at least. It knows the true start; but
// it is done one layer after another, so on many threads they would wait for it.
constexpr double kMostAnchorShare = 0.5;
constexpr double kLeastAnchorShare = 0.1;
constexpr double kThreadsWorthOfAnchor = 0.8;

// What predicting an end, or comparing with greedy, may use, and a search for a bound.
constexpr double kSideShare = 0.15;

// Layers of one kind may differ by so much in the length of a move: its ends are the same to 1e-4
// mm in either direction, relative to origins that are the same to as much.
constexpr double kSameMoveMm = 6e-4;

// What the moves of `route` come to, the one to the cleaning point apart.
struct Moves {
  MoveCounts counts;
  std::vector<Detour> detours;
};

Moves MovesOf(const LayerProblem& problem, const Route& route) {
  Moves moves;
  if (problem.cost.kind == CostSpec::Kind::kLength) return moves;
  Point at = problem.start;
  for (size_t i = 0; i < route.size(); ++i) {
    const Path& path = problem.plan->paths[static_cast<size_t>(route[i].path)];
    const Point to = EnterPoint(path, route[i].entry);
    WallMove move;
    if (problem.walls != nullptr) {
      move = problem.walls->MoveOf(at, to);
    } else {
      move.retracts = Distance(at, to) > problem.cost.retraction_threshold_mm;
    }
    moves.counts.crossings += move.crosses ? 1 : 0;
    moves.counts.retractions += move.retracts && problem.cost.retraction_seconds > 0 ? 1 : 0;
    if (!move.via.empty()) moves.detours.push_back({i, std::move(move.via)});
    at = ExitPoint(path, route[i].entry);
  }
  return moves;
}

double MoveMm(Point from, const std::optional<Point>& to) { return to ? Distance(from, *to) : 0; }

}  // namespace

// `share` of the layer's time, which is limited by itself and by its part of the job's.
Budget LayerChain::LayerBudget(const Slot& slot, double share) const {
  using Duration = Budget::Clock::duration;
  const Budget whole(&cancel_, spec_.deadline, executor_.turn());
  Duration limit = slot.allotted;
  if (spec_.layer_time_limit != absl::InfiniteDuration()) {
    limit = std::min(limit, std::chrono::duration_cast<Duration>(
                                absl::ToChronoNanoseconds(spec_.layer_time_limit)));
  }
  if (limit == Duration::max()) return whole;
  return whole.Within(std::chrono::duration_cast<Duration>(share * limit));
}

double LayerChain::AnchorShare() const {
  return std::clamp(kThreadsWorthOfAnchor / std::max(1, executor_.threads()), kLeastAnchorShare,
                    kMostAnchorShare);
}

// Nothing is left for anchor to do where the start is certain and the next layer is not looked at.
double LayerChain::SolveShare(const Slot& slot) const {
  return FixedStart(slot) && !MayLookAhead(slot) ? 1 : 1 - AnchorShare();
}

// Whether there is no time but to answer with what there is.
bool LayerChain::Expired() const { return Budget(&cancel_, spec_.deadline).ExhaustedNow(); }

LayerProblem LayerChain::Problem(const Slot& slot, Point start) const {
  LayerProblem problem{&slot.layer.plan, start, slot.finish, slot.cost,
                       StreamSeed(spec_.seed, slot.index)};
  problem.walls = slot.walls.get();
  return problem;
}

void LayerChain::Prepare(Slot& slot) {
  const Plan& plan = slot.layer.plan;
  if (slot.layer.start) given_at_ = predicted_at_ = *slot.layer.start;
  slot.predicted_start = predicted_at_;

  if (slot.cost.kind == CostSpec::Kind::kTime && !slot.layer.walls.empty()) {
    slot.walls = std::make_unique<const WallCost>(slot.layer.walls, plan, slot.cost);
  }
  slot.origin = PlanOrigin(plan);
  if (!strategy_->traits().serial) {
    slot.print = PrintOf(plan, slot.cost, slot.layer.walls);
    slot.kind = KindOf(slot.print.make, slot.origin, slot.predicted_start, slot.finish);
  }
  if (strategy_->traits().reuses_routes) {
    if (!anchored_ || FixedStart(slot)) anchored_ = std::make_shared<Anchored>();
    slot.anchored = anchored_;
  }

  slot.given_route = GivenRoute(plan);
  slot.outcome.index = slot.index;
  slot.outcome.given = MeasureTravel(plan, given_at_, slot.given_route);
  LayerProblem problem = Problem(slot, given_at_);
  problem.finish.reset();
  slot.outcome.cost_given = RouteCost(problem, slot.given_route);
  slot.outcome.moves_given = MovesOf(problem, slot.given_route).counts;
  given_at_ = RouteEnd(plan, slot.given_route, given_at_);
  slot.outcome.cleaning_given_mm = MoveMm(given_at_, slot.finish);

  if (slot.finish) given_at_ = *slot.finish;
  if (!strategy_->traits().serial) predicted_at_ = PredictEnd(slot);
}

Point LayerChain::PredictEnd(const Slot& slot) {
  if (slot.finish) return *slot.finish;
  if (const std::optional<Point> end = history_.EndOf(slot.print.make, slot.kind)) {
    return {slot.origin.x + end->x, slot.origin.y + end->y};
  }
  if (Expired()) return slot.predicted_start;
  const Route greedy = GreedyRoute(Problem(slot, slot.predicted_start), slot);
  return RouteEnd(slot.layer.plan, greedy, slot.predicted_start);
}

void LayerChain::SolveFirst(Slot& slot) const {
  const Stopwatch watch;
  if (Expired()) {
    slot.first = Solution{slot.given_route, StopReason::kTimeLimit, std::nullopt};
    return;
  }
  Budget budget = LayerBudget(slot, SolveShare(slot));
  LayerProblem problem = Problem(slot, slot.predicted_start);
  problem.memory = &slot.memory;
  // Different layers that share a fingerprint are unheard of, not impossible.
  const bool resumes =
      slot.model && ValidateRoute(slot.layer.plan, slot.model->best->solution.route).ok();
  if (resumes) {
    ResumeModel(problem, slot, budget);
  } else {
    slot.first = strategy_->Solve(problem, budget);
  }
  if (!slot.first.lower_bound) Bound(problem, slot, slot.first);
  slot.outcome.solve_seconds = watch.Seconds();
}

// Goes on from the route of an equal layer, unless searching it has long been in vain.
void LayerChain::ResumeModel(const LayerProblem& problem, Slot& slot, Budget& budget) const {
  const RouteToCome& model = *slot.model;
  slot.bound_multipliers = model.best->multipliers;
  const bool same = model.kind == slot.kind;
  if (same && model.idle >= RouteHistory::kMostIdle &&
      TakeOver(*model.best, problem, slot, slot.first)) {
    return;
  }
  const Route& route = model.best->solution.route;
  slot.first = strategy_->Resume(problem, route, budget);
  const bool gained =
      RouteCost(problem, slot.first.route) < RouteCost(problem, route) * (1 - kSameCost);
  slot.searched_in_vain = same && !gained && slot.first.stop != StopReason::kTimeLimit;
}

// Answers with the route of a layer of the same kind, as long as what was said of it holds here.
bool LayerChain::TakeOver(const KnownRoute& known, const LayerProblem& problem, const Slot& slot,
                          Solution& solution) const {
  const bool very_same = known.place == slot.print.place && known.start == problem.start &&
                         known.finish == problem.finish;
  if (!very_same && known.solution.stop != StopReason::kLocalOptimum) return false;
  if (known.solution.stop == StopReason::kTimeLimit) return false;
  solution.route = known.solution.route;
  solution.stop = known.solution.stop;
  solution.lower_bound = known.solution.lower_bound;
  if (!solution.lower_bound || very_same) return true;
  if (slot.cost.kind == CostSpec::Kind::kLength) {
    *solution.lower_bound -= kSameMoveMm * static_cast<double>(solution.route.size() + 1);
  } else {
    solution.lower_bound.reset();
  }
  return true;
}

KnownRoutePtr LayerChain::Known(const LayerProblem& problem, const Slot& slot,
                                const Solution& solution) const {
  auto known = std::make_shared<KnownRoute>();
  known->solution = solution;
  known->cost = RouteCost(problem, solution.route);
  known->place = slot.print.place;
  known->start = problem.start;
  known->finish = problem.finish;
  known->multipliers = slot.bound_multipliers;
  return known;
}

const KnownRoute* LayerChain::FindAnchored(const Slot& slot, uint64_t kind) {
  if (!slot.anchored) return nullptr;
  const auto found = slot.anchored->find(kind);
  if (found == slot.anchored->end()) return nullptr;
  return ValidateRoute(slot.layer.plan, found->second->solution.route).ok() ? found->second.get()
                                                                            : nullptr;
}

void LayerChain::SolveSecond(Slot& slot) const {
  const Stopwatch watch;
  if (Expired()) {
    slot.second = slot.first;
    slot.second.stop = StopReason::kTimeLimit;
    return;
  }
  Budget budget = LayerBudget(slot, SolveShare(slot));
  slot.second = strategy_->Solve(Problem(slot, *slot.second_start), budget);
  slot.outcome.solve_seconds += watch.Seconds();
}

// The start, where it does not depend on the layer before.
std::optional<Point> LayerChain::FixedStart(const Slot& slot) const {
  if (slot.layer.start) return slot.layer.start;
  if (slot.index == 0) return spec_.start;
  if (CleaningDueAfter(slot.index - 1)) return spec_.cleaning->point;
  return std::nullopt;
}

// In view of the next layer, if there is one: with what its best known route would cost from the
// end of this one.
double LayerChain::CostInView(const LayerProblem& problem, const Route& route,
                              const Slot* next) const {
  const double cost = RouteCost(problem, route);
  if (next == nullptr) return cost;
  const Point end = RouteEnd(*problem.plan, route, problem.start);
  const Route& known = next->foreseen.empty() ? next->first.route : next->foreseen;
  return cost + RouteCost(Problem(*next, end), known);
}

// An equal layer's from the same start may be better than that found from a predicted one, and so
// may what the layer before saw ahead.
const Route& LayerChain::BestToGoOnFrom(const LayerProblem& problem, const Slot& slot,
                                        const KnownRoute* known, const Slot* next) const {
  const Route* best = &slot.first.route;
  double least = CostInView(problem, *best, next);
  const auto offer = [&](const Route& route) {
    const double cost = CostInView(problem, route, next);
    if (cost >= least) return;
    least = cost;
    best = &route;
  };
  if (known != nullptr) offer(known->solution.route);
  if (!slot.foreseen.empty()) offer(slot.foreseen);
  return *best;
}

// `next` is null afterwards if the layer was better not ended with a view to it; `greedy` is set if
// that was to be compared with.
Solution LayerChain::SolveFromTrueStart(const LayerProblem& problem, const Slot& slot,
                                        const KnownRoute* known, Slot*& next, Route& greedy) const {
  if (strategy_->traits().serial) {
    Budget budget = LayerBudget(slot, 1);
    return strategy_->Solve(problem, budget);
  }
  const bool as_predicted = problem.start == slot.predicted_start;
  if (slot.second_start && problem.start == *slot.second_start) return slot.second;
  // What the layer was to use for a look ahead is not left unused where there is nothing to see.
  const bool has_time_left = slot.first.stop == StopReason::kTimeLimit && MayLookAhead(slot);
  if (as_predicted && next == nullptr && !has_time_left) return slot.first;
  Solution solution;
  if (known != nullptr && TakeOver(*known, problem, slot, solution)) return solution;
  if (Expired()) {
    solution = slot.first;
    solution.stop = StopReason::kTimeLimit;
    if (!as_predicted) solution.lower_bound.reset();  // it was for another start
    return solution;
  }
  Budget budget = LayerBudget(slot, AnchorShare());
  const Route& from = BestToGoOnFrom(problem, slot, known, next);
  if (next != nullptr) {
    Route foreseen = next->first.route;
    solution = strategy_->ResumeWithNext(problem, from, Problem(*next, Point()), foreseen, budget);
    greedy = GreedyRoute(problem, slot);
    if (RouteCost(problem, solution.route) <= RouteCost(problem, greedy) * (1 + kSameCost)) {
      next->foreseen = std::move(foreseen);
    } else {
      next = nullptr;
      if (as_predicted) return slot.first;
      const Route& own = BestToGoOnFrom(problem, slot, known, nullptr);
      solution = strategy_->Resume(problem, own, budget);
    }
  } else {
    solution = strategy_->traits().quick ? strategy_->Solve(problem, budget)
                                         : strategy_->Resume(problem, from, budget);
  }
  if (as_predicted && !solution.lower_bound) solution.lower_bound = slot.first.lower_bound;
  // What resuming does not tell of itself is as it was.
  solution.statistics.insert(slot.first.statistics.begin(), slot.first.statistics.end());
  // A search that the clock cut short stays so, whatever the polishing came to.
  if (slot.first.stop == StopReason::kTimeLimit) solution.stop = StopReason::kTimeLimit;
  return solution;
}

Route LayerChain::GreedyRoute(const LayerProblem& problem, const Slot& slot) const {
  Budget budget = LayerBudget(slot, kSideShare);
  return predictor_->Solve(problem, budget).route;
}

// Other routes may be better from the true start: an equal layer's from the same start; what the
// layer before saw ahead; those found for another start, where the clock cut the last search short;
// greedy's, which a resumed route need not beat; the order given. All in view of the next layer,
// for whose sake a layer's own travel may grow up to greedy's, and no further. `greedy`: its route,
// or none if nobody asked for it yet.
void LayerChain::KeepBestRoute(const LayerProblem& problem, const Slot& slot,
                               const KnownRoute* known, const Slot* next, Route greedy,
                               Solution& solution) const {
  if (greedy.empty() && GreedyMayBeBetter(problem, slot, known, next)) {
    greedy = GreedyRoute(problem, slot);
  }
  constexpr double kAny = std::numeric_limits<double>::infinity();
  const bool has_limit = next != nullptr && greedy.size() == solution.route.size();
  const double limit = has_limit ? RouteCost(problem, greedy) * (1 + kSameCost) : kAny;
  double best =
      RouteCost(problem, solution.route) > limit ? kAny : CostInView(problem, solution.route, next);
  bool was_replaced = false;
  const auto offer = [&](const Route& route) {
    if (route.size() != solution.route.size()) return;  // there was no such search
    const double cost = CostInView(problem, route, next);
    if (cost >= best || RouteCost(problem, route) > limit) return;
    best = cost;
    solution.route = route;
    was_replaced = true;
  };
  if (known != nullptr) offer(known->solution.route);
  offer(slot.foreseen);
  offer(greedy);
  if (solution.stop == StopReason::kTimeLimit || has_limit) {
    offer(slot.first.route);
    offer(slot.second.route);
  }
  offer(slot.given_route);
  // An optimal route was replaced for the sake of the next layer, or by one that is the same but
  // for rounding.
  if (was_replaced && solution.stop == StopReason::kOptimal &&
      RouteCost(problem, solution.route) > solution.lower_bound.value_or(0) * (1 + kSameCost)) {
    solution.stop = StopReason::kLocalOptimum;
  }
}

// Whether greedy's route was not beaten yet: not if the strategy began at this very start, or if an
// equal layer's route was taken over.
bool LayerChain::GreedyMayBeBetter(const LayerProblem& problem, const Slot& slot,
                                   const KnownRoute* known, const Slot* next) const {
  if (strategy_->traits().serial || strategy_->traits().quick || Expired()) return false;
  const bool is_compared =
      known != nullptr && known->place == slot.print.place && known->start == problem.start;
  return !is_compared && (next != nullptr || slot.model || problem.start != slot.predicted_start);
}

// Looks for a lower bound of a solution, if the strategy wants one. The search for it is done with
// the first solution, in parallel, or was done for an equal layer; from another start its result is
// used again.
void LayerChain::Bound(const LayerProblem& problem, Slot& slot, Solution& solution) const {
  if (!strategy_->traits().wants_bound || cancel_.cancelled()) return;
  Budget budget = LayerBudget(slot, kSideShare);
  const double cost = RouteCost(problem, solution.route);
  solution.lower_bound = LowerBound(problem, cost, &slot.bound_multipliers, budget);
  if (solution.lower_bound == cost) solution.stop = StopReason::kOptimal;
}

// What the layer's route depends on, for equal layers to share it.
uint64_t LayerChain::KindAt(const Slot& slot, const Place& place) const {
  const uint64_t kind = KindOf(slot.print.make, slot.origin, place.start, slot.finish);
  if (!place.next) return kind;
  const Slot& next = *place.next;
  return KindBefore(kind, slot.origin, next.print.make, next.origin, next.finish);
}

LayerOutcome LayerChain::Anchor(Slot& slot, const Place& place) const {
  const Stopwatch watch;
  const Point start = place.start;
  Slot* next = place.next.get();
  LayerProblem problem = Problem(slot, start);
  problem.memory = &slot.memory;
  const uint64_t kind = KindAt(slot, place);
  const KnownRoute* known = FindAnchored(slot, kind);
  if (!ValidateRoute(slot.layer.plan, slot.foreseen).ok()) slot.foreseen.clear();
  Route greedy;
  Solution solution = SolveFromTrueStart(problem, slot, known, next, greedy);
  LayerOutcome outcome = std::move(slot.outcome);
  if (absl::Status status = ValidateRoute(slot.layer.plan, solution.route); !status.ok()) {
    outcome.invalid_route = std::string(status.message());
    solution = Solution{slot.given_route, StopReason::kLocalOptimum, std::nullopt};
  } else if (!strategy_->traits().pure) {
    KeepBestRoute(problem, slot, known, next, std::move(greedy), solution);
  }
  if (!solution.lower_bound) Bound(problem, slot, solution);
  if (slot.anchored) (*slot.anchored)[kind] = slot.known = Known(problem, slot, solution);
  outcome.start = start;
  outcome.end = RouteEnd(slot.layer.plan, solution.route, start);
  outcome.travel = MeasureTravel(slot.layer.plan, start, solution.route);
  outcome.cleaning_mm = MoveMm(outcome.end, slot.finish);
  const double finish_cost = slot.finish ? TravelCost(problem)(outcome.end, *slot.finish) : 0;
  outcome.cost = RouteCost(problem, solution.route) - finish_cost;
  Moves moves = MovesOf(problem, solution.route);
  outcome.moves = moves.counts;
  outcome.detours = std::move(moves.detours);
  if (solution.lower_bound) outcome.lower_bound = *solution.lower_bound - finish_cost;
  if (problem.walls != nullptr && outcome.invalid_route.empty()) {
    const absl::Status same =
        ValidateMoves(slot.layer.plan, slot.layer.walls, slot.cost, start, solution.route,
                      {outcome.cost, outcome.moves, outcome.detours});
    if (!same.ok()) outcome.invalid_route = std::string(same.message());
  }
  outcome.stop = solution.stop;
  outcome.statistics = std::move(solution.statistics);
  outcome.route = std::move(solution.route);
  outcome.plan = std::move(slot.layer.plan);
  slot.memory.reset();
  slot.walls.reset();
  outcome.solve_seconds += watch.Seconds();
  return outcome;
}

}  // namespace traverse
