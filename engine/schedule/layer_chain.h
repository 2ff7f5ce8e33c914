// The chain of a job's layers, solved in parallel.
//
// Each layer starts where the one before ended (SPEC section 2), which seems to leave no room for
// parallel work. So every layer passes these stages:
//
//   prepare   in build order, cheap: the travel of the given order, and a prediction of where the
//             layer will end: where an equal layer ended before, else where its greedy route ends
//   solve     on any thread: the strategy, from the predicted start; where an equal layer came
//             before, it may go on from that one's route, or take it over (route_history.h)
//   second    quick strategies alone, on any thread: solve from where the first solution of the
//             layer before ends, if that is elsewhere; mostly this is the true start
//   anchor    in build order, cheap: the true start is known now; if it is yet another one, the
//             route of an equal layer that began there is taken over, or the strategy resumes its
//             route from there; the route is validated and delivered
//
// Strategies that look ahead anchor a layer together with the next one, so that it ends where the
// next one is cheap to begin: first the layer alone, then the next one from its end, then both from
// these, which is never longer. The next one's part of what is found is what it is anchored from in
// turn: nothing of that work is lost. Whether there is a next layer
// to look at is said by whoever adds the layer (JobLayer::more_follows): it is then waited for, and
// else not looked at even if it is there. There is no use in it where the next layer begins at a
// given place or at the cleaning point; the move to that counts in any case.
//
// What a stage does depends on the job and the seed alone, never on timing, so the routes are the
// same on any number of threads. Every stage of a layer is a task of its own: the executor can
// share its threads fairly between jobs, and no task waits for another.

#ifndef TRAVERSE_ENGINE_SCHEDULE_LAYER_CHAIN_H_
#define TRAVERSE_ENGINE_SCHEDULE_LAYER_CHAIN_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>

#include "engine/base/mutex.h"
#include "engine/engine.h"
#include "engine/schedule/budget_split.h"
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

  void Add(JobLayer layer) override;
  void Close() override;
  void Cancel() override;
  int64_t pending() const override;

 private:
  // Prepare is at most so many layers ahead of anchor; even, as many parts alternate two layers.
  static constexpr uint64_t kLearnDelay = 32;

  // Fixes what the layer may use of the job's time. As its main stage begins.
  void Allot(ChainLayer& layer);

  // Run a stage and hand the layer over to the next one.
  void RunPrepare(const ChainLayerPtr& layer);
  void RunSolveFirst(const ChainLayerPtr& layer);
  void RunSolveSecond(const ChainLayerPtr& layer);
  void RunAnchor(const ChainLayerPtr& layer, const TrueStart& at);

  // Submit what is due.
  void MaybePrepare() TRAVERSE_REQUIRES(mutex_);
  void MaybeSolveFirst(const ChainLayerPtr& layer) TRAVERSE_REQUIRES(mutex_);
  void HandOn(const ChainLayer& layer) TRAVERSE_REQUIRES(mutex_);
  void MaybeSolveSecond(uint64_t index) TRAVERSE_REQUIRES(mutex_);
  void MaybeAnchor(uint64_t index) TRAVERSE_REQUIRES(mutex_);
  void MaybeFinish() TRAVERSE_REQUIRES(mutex_);
  void Submit(std::function<void()> stage, int64_t points) TRAVERSE_REQUIRES(mutex_);
  void DropAnchored() TRAVERSE_REQUIRES(mutex_);
  const ChainLayerPtr& LayerAt(uint64_t index) const TRAVERSE_REQUIRES(mutex_) {
    return layers_[index - first_index_];
  }

  const JobSpec spec_;
  Executor& executor_;
  CancelToken cancel_;
  const LayerSolver solver_;
  Outbox outbox_;
  LayerPreparer preparer_;  // only prepare touches it

  mutable Mutex mutex_;
  BudgetSplit split_ TRAVERSE_GUARDED_BY(mutex_);
  RouteHistory routes_ TRAVERSE_GUARDED_BY(mutex_);
  std::deque<ChainLayerPtr> layers_ TRAVERSE_GUARDED_BY(mutex_);  // [index - first_index_]
  uint64_t first_index_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  uint64_t added_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  uint64_t next_to_prepare_ TRAVERSE_GUARDED_BY(mutex_) = 0;

  // What prepare has not learned yet of anchored layers, by index. It learns of layer i -
  // kLearnDelay right before it prepares layer i: what it knows must not depend on timing.
  struct LayerEnd {
    uint64_t shape = 0;
    uint64_t key = 0;
    Point end;            // from the plan's origin
    KnownRoutePtr known;  // null where routes are not used again
  };
  std::map<uint64_t, LayerEnd> ends_to_learn_ TRAVERSE_GUARDED_BY(mutex_);
  int64_t pending_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int64_t tasks_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // submitted and not yet ended
  bool preparing_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool closed_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool finished_ TRAVERSE_GUARDED_BY(mutex_) = false;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_CHAIN_H_
