#include "engine/schedule/layer_chain.h"

#include <utility>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/travel_cost.h"
#include "engine/strategy/greedy.h"
#include "engine/validator.h"

namespace traverse {
namespace {

// Of a layer's time limit, what solve may use; the rest is for anchor, which runs once the true
// start is known.
constexpr double kSolveShare = 0.85;

double MoveMm(Point from, const std::optional<Point>& to) { return to ? Distance(from, *to) : 0; }

}  // namespace

std::shared_ptr<Job> Job::Start(const JobSpec& spec, std::unique_ptr<Strategy> strategy,
                                Executor& executor, JobSink& sink) {
  return std::make_shared<LayerChain>(spec, std::move(strategy), executor, sink);
}

LayerChain::LayerChain(const JobSpec& spec, std::unique_ptr<Strategy> strategy, Executor& executor,
                       JobSink& sink)
    : spec_(spec),
      strategy_(std::move(strategy)),
      predictor_(GreedyEntry().make(StrategyOptions())),
      executor_(executor),
      outbox_(sink),
      given_at_(spec.start),
      predicted_at_(spec.start) {}

void LayerChain::Add(JobLayer layer) {
  auto slot = std::make_shared<Slot>();
  slot->cost = layer.cost.value_or(spec_.cost);
  slot->layer = std::move(layer);
  std::lock_guard<std::mutex> lock(mutex_);
  slot->index = added_++;
  slots_.push_back(std::move(slot));
  ++pending_;
  MaybePrepare();
}

void LayerChain::Close() {
  std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
  MaybePrepare();
  MaybeFinish();
}

void LayerChain::Cancel() {
  cancel_.Cancel();
  std::lock_guard<std::mutex> lock(mutex_);
  MaybeFinish();
}

int64_t LayerChain::pending() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return pending_;
}

bool LayerChain::CleaningDueAfter(uint64_t index) const {
  if (!spec_.cleaning) return false;
  const uint64_t done = static_cast<uint64_t>(spec_.cleaning->layers_since_cleaning) + index + 1;
  return done % static_cast<uint64_t>(spec_.cleaning->every_layers) == 0;
}

Budget LayerChain::LayerBudget(double share) const {
  const Budget whole(&cancel_, spec_.deadline);
  if (spec_.layer_time_limit == absl::InfiniteDuration()) return whole;
  return whole.Within(std::chrono::duration_cast<Budget::Clock::duration>(
      absl::ToChronoNanoseconds(spec_.layer_time_limit * share)));
}

LayerProblem LayerChain::Problem(const Slot& slot, Point start) const {
  return LayerProblem{&slot.layer.plan, start, slot.finish, slot.cost,
                      StreamSeed(spec_.seed, slot.index)};
}

void LayerChain::Prepare(Slot& slot) {
  const Plan& plan = slot.layer.plan;
  if (slot.layer.start) given_at_ = predicted_at_ = *slot.layer.start;
  slot.predicted_start = predicted_at_;

  slot.origin = PlanOrigin(plan);
  if (!strategy_->serial()) slot.fingerprint = PlanFingerprint(plan);
  if (strategy_->reuses_routes()) {
    slot.result = std::make_shared<RouteToCome>();
    slot.model = routes_.Enter(slot.fingerprint, slot.result);
  }

  slot.given_route = GivenRoute(plan);
  slot.outcome.index = slot.index;
  slot.outcome.given = MeasureTravel(plan, given_at_, slot.given_route);
  LayerProblem problem = Problem(slot, given_at_);
  problem.finish.reset();
  slot.outcome.cost_given = RouteCost(problem, slot.given_route);
  given_at_ = RouteEnd(plan, slot.given_route, given_at_);
  slot.outcome.cleaning_given_mm = MoveMm(given_at_, slot.finish);

  if (slot.finish) given_at_ = *slot.finish;
  if (!strategy_->serial()) predicted_at_ = PredictEnd(slot);
}

Point LayerChain::PredictEnd(const Slot& slot) {
  if (slot.finish) return *slot.finish;
  if (const std::optional<Point> end = history_.EndOf(slot.fingerprint)) {
    return {slot.origin.x + end->x, slot.origin.y + end->y};
  }
  Budget budget = LayerBudget(1 - kSolveShare);
  return RouteEnd(slot.layer.plan,
                  predictor_->Solve(Problem(slot, slot.predicted_start), budget).route,
                  slot.predicted_start);
}

void LayerChain::SolveFirst(Slot& slot) const {
  const Stopwatch watch;
  Budget budget = LayerBudget(kSolveShare);
  const LayerProblem problem = Problem(slot, slot.predicted_start);
  // Different layers that share a fingerprint are unheard of, not impossible.
  const bool resumes = slot.model && ValidateRoute(slot.layer.plan, slot.model->route).ok();
  if (resumes) slot.bound_multipliers = slot.model->bound_multipliers;
  slot.first = resumes ? strategy_->Resume(problem, slot.model->route, budget)
                       : strategy_->Solve(problem, budget);
  if (!slot.first.lower_bound) Bound(problem, slot, slot.first);
  slot.outcome.solve_seconds = watch.Seconds();
}

void LayerChain::SolveSecond(Slot& slot) const {
  const Stopwatch watch;
  Budget budget = LayerBudget(kSolveShare);
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

Solution LayerChain::SolveFromTrueStart(const LayerProblem& problem, const Slot& slot) const {
  if (strategy_->serial()) {
    Budget budget = LayerBudget(1);
    return strategy_->Solve(problem, budget);
  }
  if (slot.second_start && problem.start == *slot.second_start) return slot.second;
  if (problem.start == slot.predicted_start) return slot.first;
  Budget budget = LayerBudget(1 - kSolveShare);
  Solution solution = strategy_->quick() ? strategy_->Solve(problem, budget)
                                         : strategy_->Resume(problem, slot.first.route, budget);
  // What resuming does not tell of itself is as it was.
  solution.statistics.insert(slot.first.statistics.begin(), slot.first.statistics.end());
  // A search that the clock cut short stays so, whatever the polishing came to.
  if (slot.first.stop == StopReason::kTimeLimit) solution.stop = StopReason::kTimeLimit;
  return solution;
}

// Other routes may be better from the true start: those found for another start, where the clock
// cut the last search short; greedy's, which a resumed route need not beat; the order given.
void LayerChain::KeepBestRoute(const LayerProblem& problem, const Slot& slot,
                               Solution& solution) const {
  double best = RouteCost(problem, solution.route);
  const auto offer = [&](const Route& route) {
    if (route.size() != solution.route.size()) return;  // there was no such search
    const double cost = RouteCost(problem, route);
    if (cost >= best) return;
    best = cost;
    solution.route = route;
  };
  if (!strategy_->serial() && !strategy_->quick() &&
      (slot.model || problem.start != slot.predicted_start)) {
    Budget budget = LayerBudget(1 - kSolveShare);
    offer(predictor_->Solve(problem, budget).route);
  }
  if (solution.stop == StopReason::kTimeLimit) {
    offer(slot.first.route);
    offer(slot.second.route);
  }
  offer(slot.given_route);
}

// Looks for a lower bound of a solution, if the strategy wants one. The search for it is done with
// the first solution, in parallel, or was done for an equal layer; from another start its result is
// used again.
void LayerChain::Bound(const LayerProblem& problem, Slot& slot, Solution& solution) const {
  if (!strategy_->wants_bound() || cancel_.cancelled()) return;
  Budget budget = LayerBudget(1 - kSolveShare);
  const double cost = RouteCost(problem, solution.route);
  solution.lower_bound = LowerBound(problem, cost, &slot.bound_multipliers, budget);
  if (solution.lower_bound == cost) solution.stop = StopReason::kOptimal;
}

LayerOutcome LayerChain::Anchor(Slot& slot, Point start) const {
  const Stopwatch watch;
  const LayerProblem problem = Problem(slot, start);
  Solution solution = SolveFromTrueStart(problem, slot);
  LayerOutcome outcome = std::move(slot.outcome);
  if (absl::Status status = ValidateRoute(slot.layer.plan, solution.route); !status.ok()) {
    outcome.invalid_route = std::string(status.message());
    solution = Solution{slot.given_route, StopReason::kLocalOptimum, std::nullopt};
  } else {
    KeepBestRoute(problem, slot, solution);
  }
  if (!solution.lower_bound) Bound(problem, slot, solution);
  outcome.start = start;
  outcome.end = RouteEnd(slot.layer.plan, solution.route, start);
  outcome.travel = MeasureTravel(slot.layer.plan, start, solution.route);
  outcome.cleaning_mm = MoveMm(outcome.end, slot.finish);
  const double finish_cost = slot.finish ? TravelCost(slot.cost)(outcome.end, *slot.finish) : 0;
  outcome.cost = RouteCost(problem, solution.route) - finish_cost;
  if (solution.lower_bound) outcome.lower_bound = *solution.lower_bound - finish_cost;
  outcome.stop = solution.stop;
  outcome.statistics = std::move(solution.statistics);
  outcome.route = std::move(solution.route);
  outcome.plan = std::move(slot.layer.plan);
  outcome.solve_seconds += watch.Seconds();
  return outcome;
}

void LayerChain::RunPrepare(const SlotPtr& slot) {
  Prepare(*slot);
  std::lock_guard<std::mutex> lock(mutex_);
  preparing_ = false;
  ++next_to_prepare_;
  if (strategy_->serial()) {
    slot->solved = true;
    MaybeAnchor(slot->index);
  } else {
    MaybeSolveFirst(slot);
  }
  MaybePrepare();
}

void LayerChain::RunSolveFirst(const SlotPtr& slot) {
  SolveFirst(*slot);
  const Point end =
      slot->finish.value_or(RouteEnd(slot->layer.plan, slot->first.route, slot->predicted_start));
  std::lock_guard<std::mutex> lock(mutex_);
  slot->first_end = end;
  HandOn(*slot);
  MaybeSolveSecond(slot->index);
  MaybeSolveSecond(slot->index + 1);
}

void LayerChain::RunSolveSecond(const SlotPtr& slot) {
  SolveSecond(*slot);
  std::lock_guard<std::mutex> lock(mutex_);
  slot->solved = true;
  MaybeAnchor(slot->index);
}

void LayerChain::RunAnchor(const SlotPtr& slot, Point start) {
  LayerOutcome outcome = Anchor(*slot, start);
  const Point route_end = outcome.end;
  const Point end = slot->finish.value_or(route_end);
  if (!cancel_.cancelled()) outbox_.Deliver(std::move(outcome));
  std::lock_guard<std::mutex> lock(mutex_);
  slot->end = end;
  ends_to_learn_[slot->index] = {slot->fingerprint,
                                 {route_end.x - slot->origin.x, route_end.y - slot->origin.y}};
  --pending_;
  DropAnchored();
  MaybeAnchor(slot->index + 1);
  MaybePrepare();
}

// The next layer's first stage, unless it is under way, or the layer's finish is not known yet, or
// what is to be learned before it.
void LayerChain::MaybePrepare() {
  if (preparing_ || next_to_prepare_ == added_) return;
  const bool learns = next_to_prepare_ >= kLearnDelay;
  if (learns && ends_to_learn_.count(next_to_prepare_ - kLearnDelay) == 0) return;
  const bool is_last_known = next_to_prepare_ + 1 == added_;
  const bool cleaning_due = CleaningDueAfter(next_to_prepare_);
  if (cleaning_due && is_last_known && !closed_) return;
  SlotPtr slot = SlotAt(next_to_prepare_);
  if (cleaning_due && !is_last_known) slot->finish = spec_.cleaning->point;
  if (learns) {
    const auto learned = ends_to_learn_.extract(next_to_prepare_ - kLearnDelay).mapped();
    history_.Learn(learned.first, learned.second);
  }
  preparing_ = true;
  Submit([this, slot] { RunPrepare(slot); });
}

// The first solution of a layer, once there is what it starts from.
void LayerChain::MaybeSolveFirst(const SlotPtr& slot) {
  if (slot->model && !slot->model->ready) {
    slot->model->waiting.push_back(slot->index);
    return;
  }
  Submit([this, slot] { RunSolveFirst(slot); });
}

// Gives the first solution to the layers that start from it.
void LayerChain::HandOn(const Slot& slot) {
  if (!slot.result) return;
  slot.result->route = slot.first.route;
  slot.result->bound_multipliers = slot.bound_multipliers;
  slot.result->ready = true;
  for (const uint64_t index : std::exchange(slot.result->waiting, {})) {
    MaybeSolveFirst(SlotAt(index));
  }
}

// What follows the first solution of layer `index`: a second one, or anchor.
void LayerChain::MaybeSolveSecond(uint64_t index) {
  if (index < first_index_ || index >= added_) return;
  const SlotPtr slot = SlotAt(index);
  if (!slot->first_end || slot->solved || slot->second_start) return;
  if (strategy_->quick() && !FixedStart(*slot)) {
    const std::optional<Point> start = SlotAt(index - 1)->first_end;
    if (!start) return;
    if (*start != slot->predicted_start) {
      slot->second_start = start;
      Submit([this, slot] { RunSolveSecond(slot); });
      return;
    }
  }
  slot->solved = true;
  MaybeAnchor(index);
}

// The last stage of layer `index`, if it is solved and its start is known.
void LayerChain::MaybeAnchor(uint64_t index) {
  if (index < first_index_ || index >= added_) return;
  const SlotPtr slot = SlotAt(index);
  if (!slot->solved || slot->anchoring) return;
  std::optional<Point> start = FixedStart(*slot);
  if (!start) start = SlotAt(index - 1)->end;
  if (!start) return;
  slot->anchoring = true;
  Submit([this, slot, at = *start] { RunAnchor(slot, at); });
}

// Layers from the front that are done, but for the last of them: its end is the next one's start.
void LayerChain::DropAnchored() {
  while (slots_.size() > 1 && slots_[0]->end && slots_[1]->anchoring) {
    slots_.pop_front();
    ++first_index_;
  }
}

void LayerChain::MaybeFinish() {
  const bool all_done = closed_ && pending_ == 0;
  if (finished_ || tasks_ > 0 || !(all_done || cancel_.cancelled())) return;
  finished_ = true;
  executor_.Submit([self = shared_from_this()] { self->outbox_.Done(); });
}

void LayerChain::Submit(std::function<void()> stage) {
  if (cancel_.cancelled()) return;
  ++tasks_;
  executor_.Submit([self = shared_from_this(), stage = std::move(stage)] {
    if (!self->cancel_.cancelled()) stage();
    std::lock_guard<std::mutex> lock(self->mutex_);
    --self->tasks_;
    self->MaybeFinish();
  });
}

}  // namespace traverse
