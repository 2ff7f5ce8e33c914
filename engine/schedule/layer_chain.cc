#include "engine/schedule/layer_chain.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "absl/cleanup/cleanup.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/greedy.h"

namespace traverse {

std::shared_ptr<Job> Job::Start(const JobSpec& spec, std::unique_ptr<Strategy> strategy,
                                Executor& executor, JobSink& sink) {
  return std::make_shared<LayerChain>(spec, std::move(strategy), executor, sink);
}

LayerChain::LayerChain(const JobSpec& spec, std::unique_ptr<Strategy> strategy, Executor& executor,
                       JobSink& sink)
    : spec_(spec),
      strategy_(std::move(strategy)),
      predictor_(GreedyEntry().make(*StrategyOptions::Parse(GreedyEntry().options, {}))),
      executor_(executor),
      outbox_(sink),
      given_at_(spec.start),
      predicted_at_(spec.start),
      split_(spec.deadline, strategy_->traits().serial ? 1 : std::max(1, executor.threads())) {}

void LayerChain::Add(JobLayer layer) {
  auto slot = std::make_shared<Slot>();
  slot->cost = layer.cost.value_or(spec_.cost);
  for (const Path& path : layer.plan.paths)
    slot->points += static_cast<int64_t>(path.points.size());
  slot->layer = std::move(layer);
  MutexLock lock(mutex_);
  assert(!closed_);
  slot->index = added_++;
  slot->weight = BudgetSplit::Weight(slot->layer.plan.paths.size(), false);
  split_.Add(slot->weight);
  slots_.push_back(std::move(slot));
  ++pending_;
  MaybePrepare();
  // It may be one that the layer before need not look at.
  if (added_ > 1) MaybeAnchor(added_ - 2);
}

void LayerChain::Close() {
  MutexLock lock(mutex_);
  closed_ = true;
  MaybePrepare();
  if (added_ > 0) MaybeAnchor(added_ - 1);
  MaybeFinish();
}

void LayerChain::Cancel() {
  cancel_.Cancel();
  MutexLock lock(mutex_);
  MaybeFinish();
}

int64_t LayerChain::pending() const {
  MutexLock lock(mutex_);
  return pending_;
}

bool LayerChain::CleaningDueAfter(uint64_t index) const {
  if (!spec_.cleaning) return false;
  const uint64_t done = static_cast<uint64_t>(spec_.cleaning->layers_since_cleaning) + index + 1;
  return done % static_cast<uint64_t>(spec_.cleaning->every_layers) == 0;
}

void LayerChain::RunPrepare(const SlotPtr& slot) {
  Prepare(*slot);
  MutexLock lock(mutex_);
  preparing_ = false;
  ++next_to_prepare_;
  if (strategy_->traits().reuses_routes) {
    slot->result = std::make_shared<RouteToCome>();
    slot->model = routes_.Enter(slot->print.make, slot->kind, slot->result);
  }
  if (slot->model) {
    const double weight = BudgetSplit::Weight(slot->layer.plan.paths.size(), true);
    split_.Add(weight - slot->weight);
    slot->weight = weight;
  }
  if (strategy_->traits().serial) {
    slot->solved = true;
    MaybeAnchor(slot->index);
  } else {
    MaybeSolveFirst(slot);
  }
  MaybePrepare();
}

void LayerChain::Allot(Slot& slot) {
  MutexLock lock(mutex_);
  slot.allotted = split_.Begin(slot.weight, Budget::Clock::now());
}

void LayerChain::RunSolveFirst(const SlotPtr& slot) {
  Allot(*slot);
  SolveFirst(*slot);
  const Point end =
      slot->finish.value_or(RouteEnd(slot->layer.plan, slot->first.route, slot->predicted_start));
  MutexLock lock(mutex_);
  slot->first_end = end;
  HandOn(*slot);
  MaybeSolveSecond(slot->index);
  MaybeSolveSecond(slot->index + 1);
  if (slot->index > 0) MaybeAnchor(slot->index - 1);
}

void LayerChain::RunSolveSecond(const SlotPtr& slot) {
  SolveSecond(*slot);
  MutexLock lock(mutex_);
  slot->solved = true;
  MaybeAnchor(slot->index);
}

void LayerChain::RunAnchor(const SlotPtr& slot, const Place& place) {
  if (strategy_->traits().serial) Allot(*slot);
  LayerOutcome outcome = Anchor(*slot, place);
  const Point route_end = outcome.end;
  const Point end = slot->finish.value_or(route_end);
  if (!cancel_.cancelled()) outbox_.Deliver(std::move(outcome));
  MutexLock lock(mutex_);
  slot->end = end;
  Lesson& lesson = lessons_[slot->index];
  lesson.make = slot->print.make;
  lesson.kind = KindOf(lesson.make, slot->origin, place.start, slot->finish);
  lesson.end = RelativeTo(slot->origin, route_end);
  lesson.known = slot->known;
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
  if (learns && lessons_.count(next_to_prepare_ - kLearnDelay) == 0) return;
  const bool is_last_known = next_to_prepare_ + 1 == added_;
  const bool cleaning_due = CleaningDueAfter(next_to_prepare_);
  if (cleaning_due && is_last_known && !closed_) return;
  SlotPtr slot = SlotAt(next_to_prepare_);
  if (cleaning_due && !is_last_known) slot->finish = spec_.cleaning->point;
  if (learns) {
    const Lesson lesson = lessons_.extract(next_to_prepare_ - kLearnDelay).mapped();
    history_.Learn(lesson.make, lesson.kind, lesson.end);
    if (lesson.known) routes_.Learn(lesson.make, lesson.kind, lesson.known);
  }
  preparing_ = true;
  Submit([this, slot] { RunPrepare(slot); }, slot->points);
}

// The first solution of a layer, once there is what it starts from.
void LayerChain::MaybeSolveFirst(const SlotPtr& slot) {
  if (slot->model && !slot->model->ready) {
    slot->model->waiting.push_back(slot->index);
    return;
  }
  Submit([this, slot] { RunSolveFirst(slot); }, slot->points);
}

// Gives the first solution to the layers that start from it.
void LayerChain::HandOn(const Slot& slot) {
  if (!slot.result) return;
  const LayerProblem problem = Problem(slot, slot.predicted_start);
  for (const uint64_t index : RouteHistory::Complete(slot.result, Known(problem, slot, slot.first),
                                                     slot.searched_in_vain)) {
    MaybeSolveFirst(SlotAt(index));
  }
}

// What follows the first solution of layer `index`: a second one, or anchor.
void LayerChain::MaybeSolveSecond(uint64_t index) {
  if (index < first_index_ || index >= added_) return;
  const SlotPtr slot = SlotAt(index);
  if (!slot->first_end || slot->solved || slot->second_start) return;
  if (strategy_->traits().quick && !FixedStart(*slot)) {
    const std::optional<Point> start = SlotAt(index - 1)->first_end;
    if (!start) return;
    if (*start != slot->predicted_start) {
      slot->second_start = start;
      Submit([this, slot] { RunSolveSecond(slot); }, slot->points);
      return;
    }
  }
  slot->solved = true;
  MaybeAnchor(index);
}

// Whether the layer's end is worth a look at the next layer, if there will be one.
bool LayerChain::MayLookAhead(const Slot& slot) const {
  const size_t paths = slot.layer.plan.paths.size();
  return slot.layer.more_follows && !CleaningDueAfter(slot.index) && paths > 0 &&
         paths < strategy_->traits().look_ahead_paths;
}

// Whether it is worth a look at `next`.
bool LayerChain::LooksAheadAt(const Slot& slot, const Slot& next) const {
  if (FixedStart(next) || next.cost != slot.cost) return false;
  const size_t paths = next.layer.plan.paths.size();
  return paths > 0 && slot.layer.plan.paths.size() + paths <= strategy_->traits().look_ahead_paths;
}

// The last stage of layer `index`, if it is solved, its start is known, and so is whatever it is to
// look at of the next one.
void LayerChain::MaybeAnchor(uint64_t index) {
  if (index < first_index_ || index >= added_) return;
  const SlotPtr slot = SlotAt(index);
  if (!slot->solved || slot->anchoring) return;
  std::optional<Point> start = FixedStart(*slot);
  if (!start) start = SlotAt(index - 1)->end;
  if (!start) return;
  Place place{*start, nullptr};
  if (MayLookAhead(*slot)) {
    const bool is_last_known = index + 1 == added_;
    if (is_last_known && !closed_) return;
    if (!is_last_known && LooksAheadAt(*slot, *SlotAt(index + 1))) place.next = SlotAt(index + 1);
    if (place.next && !place.next->first_end) return;
  }
  slot->anchoring = true;
  Submit([this, slot, place] { RunAnchor(slot, place); }, slot->points);
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

void LayerChain::Submit(std::function<void()> stage, int64_t points) {
  if (cancel_.cancelled()) return;
  ++tasks_;
  auto run = [self = shared_from_this(), stage = std::move(stage)] {
    // Also if the stage runs out of memory: whoever ran it can then cancel the job, which ends.
    const absl::Cleanup end = [&self] {
      MutexLock lock(self->mutex_);
      --self->tasks_;
      self->MaybeFinish();
    };
    if (!self->cancel_.cancelled()) stage();
  };
  executor_.SubmitLarge(std::move(run), points);
}

}  // namespace traverse
