// The chain of a job's layers, solved in parallel.
//
// Each layer starts where the one before ended (SPEC section 2), which seems to leave no room for
// parallel work. So every layer passes these stages:
//
//   prepare   in build order, cheap: the travel of the given order, and a prediction of where the
//             layer will end: where an equal layer ended before, else where its greedy route ends
//   solve     on any thread: the strategy, from the predicted start; after an equal layer it may
//             continue from that one's route, or reuse it (route_history.h)
//   second    only quick strategies, on any thread: solve from where the first solution of the
//             layer before ends, if that is elsewhere; usually this is the true start
//   alone     only layers that look ahead or are looked at, in build order, cheap: anchor as if no
//             layer looked ahead. So a second chain is known, of layers solved one after the other
//   anchor    in build order, cheap: now the true start is known. If it is yet another one, reuse
//             the route of an equal layer that began there, or let the strategy resume its route
//             from there; validate and deliver the route
//
// Strategies that look ahead anchor a layer with the next ones in view, so that it ends where they
// are cheap to begin: first the layer alone, then each of the next ones from the end of the one
// before, then all from these, which is never longer. The anchoring of the next layers starts from
// their parts of the result, so that no work is lost. The caller says whether another layer follows
// (JobLayer::more_follows). If so, the chain waits for that layer; if not, it ignores the next
// layer even if that is there. Looking ahead is useless where the next layer begins at a given
// point or at the cleaning point; the move to that point counts in any case.
//
// A chain of such layers may still end longer than layers one after the other. So an end is chosen
// only if a way back to these is known from there by which the job up to there is no longer: the
// layers in view as they are foreseen, up to one that ends where it would end alone, or that is
// done as it would be alone. Otherwise the layer takes the way known before.
//
// What a stage does depends only on the job and the seed, never on timing, so the routes are the
// same on any number of threads. Every stage of a layer is a separate task: the executor can share
// its threads fairly between jobs, and no task waits for another.

#ifndef TRAVERSE_ENGINE_SCHEDULE_LAYER_CHAIN_H_
#define TRAVERSE_ENGINE_SCHEDULE_LAYER_CHAIN_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "engine/base/mutex.h"
#include "engine/engine.h"
#include "engine/schedule/budget_split.h"
#include "engine/schedule/chain_bound.h"
#include "engine/schedule/chain_layer.h"
#include "engine/schedule/layer_preparer.h"
#include "engine/schedule/layer_solver.h"
#include "engine/schedule/outbox.h"
#include "engine/schedule/route_history.h"

namespace traverse {

class LayerChain : public Job, public std::enable_shared_from_this<LayerChain> {
 public:
  // See Job::Start.
  LayerChain(const JobSpec& spec, std::unique_ptr<Strategy> strategy, Executor& executor,
             JobSink& sink);

  void Announce(const Plan& plan) override;
  void AnnounceEnd() override;
  void Add(JobLayer layer) override;
  void Close() override;
  void Cancel() override;
  int64_t pending() const override;

 private:
  // Layers that prepare may be ahead of anchor. Even, because many parts alternate two layers.
  static constexpr uint64_t kLearnDelay = 32;

  // Layers of one shape that are solved one after the other as well. Further ones, and all behind
  // them, are answered from what was found before: keeping them within layers alone would let a
  // long part that repeats its layers take more time and become longer.
  static constexpr int kMostSeenAlone = 4;

  // Runs `stage` of a layer within the time that the layer still has. `main`: its first search,
  // which fixes the share of the job's time that the layer may use.
  template <typename Stage>
  void RunTimed(ChainLayer& layer, bool main, Stage stage);

  Budget::Clock::time_point Now() const { return Budget::Now(spec_.time); }

  // Run a stage and hand the layer to the next one.
  void RunPrepare(const ChainLayerPtr& layer);
  void RunSolveFirst(const ChainLayerPtr& layer);
  void RunSolveSecond(const ChainLayerPtr& layer);
  void RunSolveAlone(const ChainLayerPtr& layer, Point start);
  void RunAnchor(const ChainLayerPtr& layer, TrueStart at);

  // The job's last task, if its strategy bounds the chain.
  void RunBoundChain();

  // Submit the stages that are due.
  void MaybePrepare() TRAVERSE_REQUIRES(mutex_);
  void MaybeSolveFirst(const ChainLayerPtr& layer) TRAVERSE_REQUIRES(mutex_);
  void HandOn(const ChainLayer& layer) TRAVERSE_REQUIRES(mutex_);
  void MaybeSolveSecond(uint64_t index) TRAVERSE_REQUIRES(mutex_);
  void GoOnSolved(const ChainLayerPtr& layer) TRAVERSE_REQUIRES(mutex_);
  void MaybeSolveAlone(uint64_t index) TRAVERSE_REQUIRES(mutex_);
  bool ViewFrom(uint64_t index, TrueStart& at) const TRAVERSE_REQUIRES(mutex_);
  void MaybeAnchorBefore(uint64_t index) TRAVERSE_REQUIRES(mutex_);
  void MaybeAnchor(uint64_t index) TRAVERSE_REQUIRES(mutex_);
  bool BoundsChain() const {
    return solver_.traits().chain_bounding != StrategyTraits::ChainBounding::kNone;
  }
  void KeepForBound(const ChainLayer& layer, const LayerOutcome& outcome);
  void MaybeFinish() TRAVERSE_REQUIRES(mutex_);
  void Submit(std::function<void()> stage, const ChainLayer& layer) TRAVERSE_REQUIRES(mutex_);
  void Submit(std::function<void()> stage, int64_t points, uint64_t rank) TRAVERSE_REQUIRES(mutex_);

  // Runs the stages that are due once no time is left for searching, one after the other.
  void RunLate() TRAVERSE_EXCLUDES(mutex_);
  void DropAnchored() TRAVERSE_REQUIRES(mutex_);
  const ChainLayerPtr& LayerAt(uint64_t index) const TRAVERSE_REQUIRES(mutex_) {
    return layers_[index - first_index_];
  }

  const JobSpec spec_;
  Executor& executor_;
  CancelToken cancel_;
  const LayerSolver solver_;
  Outbox outbox_;
  LayerPreparer preparer_;  // used only by prepare

  mutable Mutex mutex_;
  BudgetSplit split_ TRAVERSE_GUARDED_BY(mutex_);
  RouteHistory routes_ TRAVERSE_GUARDED_BY(mutex_);
  std::deque<ChainLayerPtr> layers_ TRAVERSE_GUARDED_BY(mutex_);  // [index - first_index_]
  uint64_t first_index_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  uint64_t added_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  uint64_t next_to_prepare_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  bool repeats_ TRAVERSE_GUARDED_BY(mutex_) = false;  // see kMostSeenAlone

  // What prepare has not yet learned from anchored layers, by index. It learns from layer i -
  // kLearnDelay right before it prepares layer i, so that its knowledge does not depend on timing.
  struct LayerEnd {
    uint64_t shape = 0;
    uint64_t key = 0;
    Point end;            // relative to the plan's origin
    KnownRoutePtr known;  // null if routes are not reused
  };
  std::map<uint64_t, LayerEnd> ends_to_learn_ TRAVERSE_GUARDED_BY(mutex_);
  ChainBound chain_bound_ TRAVERSE_GUARDED_BY(mutex_);   // of the anchored layers
  double chain_weight_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // what bounding them has of the time
  bool has_links_ TRAVERSE_GUARDED_BY(mutex_) = false;   // some layer: then the chain has no bound
  bool bounding_chain_ TRAVERSE_GUARDED_BY(mutex_) = false;  // RunBoundChain has been submitted
  std::optional<double> chain_lower_bound_ TRAVERSE_GUARDED_BY(mutex_);
  int64_t pending_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int64_t tasks_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // submitted and not yet ended

  // Stages due after the end of the search. One task runs them all, so that they do not wait for a
  // thread again and again.
  std::deque<std::function<void()>> late_ TRAVERSE_GUARDED_BY(mutex_);
  bool running_late_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool preparing_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool closed_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool finished_ TRAVERSE_GUARDED_BY(mutex_) = false;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_CHAIN_H_
