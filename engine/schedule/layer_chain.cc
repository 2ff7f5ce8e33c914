#include "engine/schedule/layer_chain.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "absl/cleanup/cleanup.h"
#include "engine/cost/link_cost.h"
#include "engine/cost/route_cost.h"

namespace traverse {

std::shared_ptr<Job> Job::Start(const JobSpec& spec, std::unique_ptr<Strategy> strategy,
                                Executor& executor, JobSink& sink) {
  return std::make_shared<LayerChain>(spec, std::move(strategy), executor, sink);
}

LayerChain::LayerChain(const JobSpec& spec, std::unique_ptr<Strategy> strategy, Executor& executor,
                       JobSink& sink)
    : spec_(spec),
      executor_(executor),
      solver_(spec, std::move(strategy), executor, cancel_),
      outbox_(sink),
      preparer_(spec.start, solver_),
      split_(spec.deadline, Now(), solver_.traits().serial ? 1 : std::max(1, executor.threads())) {}

void LayerChain::Announce(const Plan& plan) {
  const LayerSize size = SizeOf(plan);
  MutexLock lock(mutex_);
  split_.Announce(size);
}

void LayerChain::AnnounceEnd() {
  MutexLock lock(mutex_);
  split_.AnnounceEnd();
}

void LayerChain::Add(JobLayer given) {
  auto layer = std::make_shared<ChainLayer>();
  layer->cost = SymmetricCost(given.cost.value_or(spec_.cost), given.links);
  layer->size = SizeOf(given.plan);
  layer->given = std::move(given);
  MutexLock lock(mutex_);
  assert(!closed_);
  layer->index = added_++;
  layer->weight = BudgetSplit::Weight(layer->size.paths, false);
  split_.AddLayer(layer->size);
  if (BoundsChain()) {
    split_.Add(layer->weight);
    chain_weight_ += layer->weight;
  }
  layer->looks_ahead = solver_.MayLookAhead(*layer, {});
  // A layer that looks ahead is still as it was given: it waits for this one.
  layer->looked_at = !layers_.empty() && layers_.back()->looks_ahead &&
                     solver_.LooksAheadAt(*layers_.back(), {}, *layer);
  layers_.push_back(std::move(layer));
  ++pending_;
  MaybePrepare();
  // It may be one that the layers before need not look at.
  MaybeAnchorBefore(added_ - 1);
}

void LayerChain::Close() {
  MutexLock lock(mutex_);
  closed_ = true;
  split_.AnnounceEnd();
  MaybePrepare();
  MaybeAnchorBefore(added_);
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

void LayerChain::RunPrepare(const ChainLayerPtr& layer) {
  RunTimed(*layer, false, [&] { preparer_.Prepare(*layer); });
  MutexLock lock(mutex_);
  split_.NoteTaken(layer->size, layer->used);
  layer->used = {};
  preparing_ = false;
  ++next_to_prepare_;
  if (solver_.traits().reuses_routes) {
    layer->result = std::make_shared<PendingRoute>();
    layer->precursor = routes_.Enter(layer->fingerprint.shape, layer->key, layer->result);
    repeats_ = repeats_ || routes_.Seen(layer->fingerprint.shape) > kMostSeenAlone;
    layer->carries_alone = layer->carries_alone && !repeats_;
  }
  if (layer->precursor || layer->resumes_initial) {
    const double weight = BudgetSplit::Weight(layer->given.plan.paths.size(), true);
    split_.Add(weight - layer->weight);
    layer->weight = weight;
  }
  if (solver_.traits().serial) {
    GoOnSolved(layer);
  } else {
    MaybeSolveFirst(layer);
  }
  MaybePrepare();
}

template <typename Stage>
void LayerChain::RunTimed(ChainLayer& layer, bool main, Stage stage) {
  const Budget::Clock::time_point begin = Now();
  {
    MutexLock lock(mutex_);
    if (main) layer.allotted = split_.Begin(layer.weight, begin);
    layer.search_end = split_.SearchEnd();
    layer.greedy_end = split_.GreedyEnd(layer.size);
  }
  if (layer.search_end && layer.allotted != Budget::Clock::duration::max())
    layer.search_end = std::min(*layer.search_end, begin + layer.allotted - layer.used);
  stage();
  layer.used += Now() - begin;
}

void LayerChain::RunSolveFirst(const ChainLayerPtr& layer) {
  RunTimed(*layer, true, [&] { solver_.SolveFirst(*layer); });
  const Point end = layer->finish.value_or(
      RouteEnd(layer->given.plan, layer->first.route, layer->predicted_start));
  MutexLock lock(mutex_);
  layer->first_end = end;
  HandOn(*layer);
  MaybeSolveSecond(layer->index);
  MaybeSolveSecond(layer->index + 1);
  MaybeAnchorBefore(layer->index);
}

void LayerChain::RunSolveSecond(const ChainLayerPtr& layer) {
  RunTimed(*layer, false, [&] { solver_.SolveSecond(*layer); });
  MutexLock lock(mutex_);
  GoOnSolved(layer);
}

void LayerChain::RunSolveAlone(const ChainLayerPtr& layer, Point start) {
  RunTimed(*layer, false, [&] { solver_.SolveAlone(*layer, start); });
  if (!layer->alone) return;  // cancelled
  const Point end = LayerSolver::EndAlone(*layer);
  MutexLock lock(mutex_);
  layer->alone_end = end;
  MaybeSolveAlone(layer->index + 1);
  MaybeAnchor(layer->index);
  MaybeAnchorBefore(layer->index);
}

void LayerChain::RunAnchor(const ChainLayerPtr& layer, TrueStart at) {
  {
    MutexLock lock(mutex_);
    const uint64_t next = layer->index + 1;
    at.is_followed = next < added_ ? !solver_.FixedStart(*LayerAt(next)).has_value()
                                   : !closed_ && !solver_.CleaningDueAfter(layer->index);
    if (at.is_followed && next < next_to_prepare_) at.next = LayerAt(next);
  }
  LayerOutcome outcome;
  const Budget::Clock::duration used = layer->used;
  const bool late = layer->search_end && Now() >= *layer->search_end;
  RunTimed(*layer, solver_.traits().serial, [&] { outcome = solver_.Anchor(*layer, at); });
  const bool has_links = LayerSolver::IsLinked(*layer, at.departure);
  if (BoundsChain() && !has_links && !cancel_.cancelled()) KeepForBound(*layer, outcome);
  const Point route_end = outcome.end;
  const Point end = layer->finish.value_or(route_end);
  const LinkSeconds departure = layer->finish ? LinkSeconds() : outcome.departure;
  // Costs with links cannot be compared with those of the search.
  const bool compares_alone = layer->alone && !has_links;
  const bool compares_greedy = layer->greedy && !has_links;
  const double over_alone = compares_alone ? at.over_alone + outcome.cost - layer->alone->cost : 0;
  const double over_greedy =
      compares_greedy ? at.over_greedy + outcome.cost - layer->greedy->cost : 0;
  if (!cancel_.cancelled()) outbox_.Deliver(std::move(outcome));
  MutexLock lock(mutex_);
  layer->end = end;
  layer->departure = departure;
  has_links_ = has_links_ || has_links;
  layer->over_alone = over_alone;
  layer->over_greedy = over_greedy;
  LayerEnd& learned = ends_to_learn_[layer->index];
  learned.shape = layer->fingerprint.shape;
  learned.key = ProblemKey(learned.shape, layer->origin, at.start, layer->finish);
  learned.end = RelativeTo(layer->origin, route_end);
  learned.known = layer->known;
  --pending_;
  split_.NoteAnswered(layer->size);
  if (late) split_.NoteTaken(layer->size, layer->used - used);
  DropAnchored();
  MaybeSolveAlone(layer->index + 1);
  MaybeAnchor(layer->index + 1);
  MaybePrepare();
}

void LayerChain::KeepForBound(const ChainLayer& layer, const LayerOutcome& outcome) {
  BoundedLayer kept{outcome.plan,  outcome.route,
                    outcome.start, !solver_.FixedStart(layer).has_value(),
                    layer.finish,  layer.cost};
  MutexLock lock(mutex_);
  chain_bound_.Add(layer.index, std::move(kept));
}

void LayerChain::RunBoundChain() {
  ChainBound chain;
  uint64_t layers = 0;
  Budget::Clock::duration allotted;
  {
    MutexLock lock(mutex_);
    std::swap(chain, chain_bound_);
    layers = added_;
    allotted = split_.Begin(chain_weight_, Now());
  }
  const std::optional<double> bound = solver_.BoundChain(chain, layers, allotted);
  MutexLock lock(mutex_);
  chain_lower_bound_ = bound;
}

// The next layer's first stage, unless it is running, or the layer's finish is still unknown, or
// what must be learned before it.
void LayerChain::MaybePrepare() {
  if (preparing_ || next_to_prepare_ == added_) return;
  const bool learns = next_to_prepare_ >= kLearnDelay;
  if (learns && ends_to_learn_.count(next_to_prepare_ - kLearnDelay) == 0) return;
  const bool is_last_known = next_to_prepare_ + 1 == added_;
  const bool cleaning_due = solver_.CleaningDueAfter(next_to_prepare_);
  if (cleaning_due && is_last_known && !closed_) return;
  ChainLayerPtr layer = LayerAt(next_to_prepare_);
  if (cleaning_due && !is_last_known) layer->finish = spec_.cleaning->point;
  if (learns) {
    const LayerEnd learned = ends_to_learn_.extract(next_to_prepare_ - kLearnDelay).mapped();
    preparer_.Learn(learned.shape, learned.key, learned.end);
    if (learned.known) routes_.Learn(learned.shape, learned.key, learned.known);
  }
  preparing_ = true;
  Submit([this, layer] { RunPrepare(layer); }, *layer);
}

// The first solution of a layer, once there is a route to start from.
void LayerChain::MaybeSolveFirst(const ChainLayerPtr& layer) {
  if (layer->precursor && !layer->precursor->ready) {
    layer->precursor->waiting.push_back(layer->index);
    return;
  }
  Submit([this, layer] { RunSolveFirst(layer); }, *layer);
}

// Gives the first solution to the layers that start from it.
void LayerChain::HandOn(const ChainLayer& layer) {
  if (!layer.result) return;
  const LayerProblem problem = solver_.Problem(layer, layer.predicted_start);
  for (const uint64_t index : RouteHistory::Complete(
           layer.result, solver_.Known(problem, layer, layer.first), layer.searched_in_vain)) {
    MaybeSolveFirst(LayerAt(index));
  }
}

// What follows the first solution of layer `index`: a second one, or anchor.
void LayerChain::MaybeSolveSecond(uint64_t index) {
  if (index < first_index_ || index >= added_) return;
  const ChainLayerPtr layer = LayerAt(index);
  if (!layer->first_end || layer->solved || layer->second_start) return;
  if (solver_.traits().quick && !solver_.FixedStart(*layer)) {
    const std::optional<Point> start = LayerAt(index - 1)->first_end;
    if (!start) return;
    if (*start != layer->predicted_start) {
      layer->second_start = start;
      Submit([this, layer] { RunSolveSecond(layer); }, *layer);
      return;
    }
  }
  GoOnSolved(layer);
}

// What follows once the layer's true start can be used: alone, or anchor.
void LayerChain::GoOnSolved(const ChainLayerPtr& layer) {
  layer->solved = true;
  MaybeSolveAlone(layer->index);
  MaybeAnchor(layer->index);
}

// The stage of layer `index`, if it is solved and its start in the chain of layers alone is known.
void LayerChain::MaybeSolveAlone(uint64_t index) {
  if (index < first_index_ || index >= added_) return;
  const ChainLayerPtr layer = LayerAt(index);
  if (!layer->solved || !layer->carries_alone || layer->solving_alone) return;
  std::optional<Point> start = solver_.FixedStart(*layer);
  if (!start) {
    const ChainLayer& before = *LayerAt(index - 1);
    start = layer->looked_at ? before.alone_end : before.end;
  }
  if (!start) return;
  layer->solving_alone = true;
  Submit([this, layer, start = *start] { RunSolveAlone(layer, start); }, *layer);
}

// Sets the layers that layer `index` is ended in view of; returns false while one of them is
// missing.
bool LayerChain::ViewFrom(uint64_t index, TrueStart& at) const {
  const ChainLayer& layer = *LayerAt(index);
  LayersInView& view = at.view;
  while (solver_.MayLookAhead(layer, view)) {
    const uint64_t next = index + view.size() + 1;
    if (next == added_) return closed_;
    if (!solver_.LooksAheadAt(layer, view, *LayerAt(next))) {
      at.end_is_free = solver_.FixedStart(*LayerAt(next)).has_value();
      return true;
    }
    const ChainLayerPtr& in_view = LayerAt(next);
    if (!in_view->first_end || (in_view->carries_alone && !in_view->alone_end)) return false;
    view.push_back(in_view);
  }
  const ChainLayer& last = view.empty() ? layer : *view.back();
  at.end_is_free = !last.given.more_follows || solver_.CleaningDueAfter(last.index);
  return true;
}

// The last stage of the layers that may have waited for layer `index`.
void LayerChain::MaybeAnchorBefore(uint64_t index) {
  for (uint64_t back = 1; back <= LayerSolver::kMostInView + 1 && back <= index; ++back) {
    MaybeAnchor(index - back);
  }
}

// The last stage of layer `index`, if it is solved, and its start and its view are known.
void LayerChain::MaybeAnchor(uint64_t index) {
  if (index < first_index_ || index >= added_) return;
  const ChainLayerPtr layer = LayerAt(index);
  if (!layer->solved || layer->anchoring || (layer->carries_alone && !layer->alone_end)) return;
  std::optional<Point> start = solver_.FixedStart(*layer);
  if (!start) start = LayerAt(index - 1)->end;
  if (!start) return;
  TrueStart at{*start, {}};
  if (layer->looked_at) at.over_alone = LayerAt(index - 1)->over_alone;
  if (!solver_.FixedStart(*layer)) {
    at.over_greedy = LayerAt(index - 1)->over_greedy;
    at.departure = LayerAt(index - 1)->departure;
  }
  if (!ViewFrom(index, at)) return;
  layer->anchoring = true;
  Submit([this, layer, at] { RunAnchor(layer, at); }, *layer);
}

// Layers from the front that are done, except the last of them: its end is the next one's start.
void LayerChain::DropAnchored() {
  while (layers_.size() > 1 && layers_[0]->end && layers_[1]->anchoring) {
    layers_.pop_front();
    ++first_index_;
  }
}

void LayerChain::MaybeFinish() {
  const bool all_done = closed_ && pending_ == 0;
  if (finished_ || tasks_ > 0 || !(all_done || cancel_.cancelled())) return;
  if (BoundsChain() && !has_links_ && !bounding_chain_ && !cancel_.cancelled()) {
    bounding_chain_ = true;
    Submit([this] { RunBoundChain(); }, chain_bound_.points(), added_);
    return;
  }
  const std::optional<double> bound = cancel_.cancelled() ? std::nullopt : chain_lower_bound_;
  executor_.Submit([self = shared_from_this(), bound] { self->outbox_.Done(bound); });
  finished_ = true;
}

// Earlier layers first: their ends are what the anchors of all others wait for.
void LayerChain::Submit(std::function<void()> stage, const ChainLayer& layer) {
  Submit(std::move(stage), layer.size.points, layer.index);
}

void LayerChain::Submit(std::function<void()> stage, int64_t points, uint64_t rank) {
  if (cancel_.cancelled()) return;
  const std::optional<Budget::Clock::time_point> search_end = split_.SearchEnd();
  const Budget::Clock::time_point submitted = Now();
  if (search_end && submitted >= *search_end) {
    late_.push_back(std::move(stage));
    if (running_late_) return;
    running_late_ = true;
    stage = [this] { RunLate(); };
  }
  auto run = [self = shared_from_this(), stage = std::move(stage), submitted] {
    // Also if the stage runs out of memory: its caller can then cancel the job, which ends.
    const absl::Cleanup end = [&self] {
      MutexLock lock(self->mutex_);
      --self->tasks_;
      self->MaybeFinish();
    };
    if (self->cancel_.cancelled()) return;
    {
      MutexLock lock(self->mutex_);
      self->split_.NoteWait(self->Now() - submitted);
    }
    stage();
  };
  // There may be no memory for it. Its end takes the lock, so it is counted in time.
  executor_.SubmitLarge(std::move(run), points, rank);
  ++tasks_;
}

void LayerChain::RunLate() {
  while (true) {
    std::function<void()> stage;
    {
      MutexLock lock(mutex_);
      if (late_.empty() || cancel_.cancelled()) {
        running_late_ = false;
        return;
      }
      stage = std::move(late_.front());
      late_.pop_front();
    }
    stage();
  }
}

}  // namespace traverse
