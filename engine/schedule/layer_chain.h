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
// Strategies that look ahead anchor a layer together with the next one, from the first solutions of
// both, so that it ends where the next one is cheap to begin. The next one's part of what is found
// is what it is anchored from in turn: nothing of that work is lost. Whether there is a next layer
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
#include <optional>
#include <unordered_map>
#include <utility>

#include "engine/base/mutex.h"
#include "engine/cost/wall_cost.h"
#include "engine/engine.h"
#include "engine/proof/bounds/lower_bound.h"
#include "engine/schedule/budget_split.h"
#include "engine/schedule/end_history.h"
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
  // The best routes of layers that were anchored, by kind.
  using Anchored = std::unordered_map<uint64_t, KnownRoutePtr>;

  // One layer on its way. A stage owns its layer and works without the lock; hand-over is under it.
  struct Slot {
    uint64_t index = 0;
    JobLayer layer;
    CostSpec cost;
    int64_t points = 0;

    // Set by prepare.
    Point predicted_start;
    PlanPrint print;
    Point origin;
    uint64_t kind = 0;  // with the predicted start
    std::unique_ptr<const WallCost> walls;
    std::optional<Point> finish;
    Route given_route;
    LayerOutcome outcome;  // what concerns the given order

    // Set by prepare, where routes are used again: the route to start from, null if there is
    // none, and this layer's own, for others. What they hold is guarded by the lock; it does not
    // change once it is ready.
    RouteHistory::Entry model;
    RouteHistory::Entry result;

    // Set by prepare: what is known of the layers before this one back to the last whose start was
    // certain. Only anchor touches what it holds.
    std::shared_ptr<Anchored> anchored;

    // What the layer may use of the job's time, once it has begun to be solved.
    double weight = 0;
    Budget::Clock::duration allotted = Budget::Clock::duration::max();

    std::unique_ptr<PlanMemory> memory;  // of the stage that is under way, for the next one

    // Set by solve and second.
    Solution first;
    bool searched_in_vain = false;  // RouteToCome
    BoundMultipliers bound_multipliers;
    std::optional<Point> second_start;
    Solution second;

    // Set by the anchor of the layer before, where that looked ahead: a route from its end.
    Route foreseen;

    // Set by anchor, where routes are used again.
    KnownRoutePtr known;

    // Guarded by the lock.
    std::optional<Point> first_end;  // solved: where the head is then, a cleaning included
    bool solved = false;             // the layer itself is ready to be anchored
    bool anchoring = false;          // anchor is submitted
    std::optional<Point> end;        // anchored: where the head is then, a cleaning included
  };
  using SlotPtr = std::shared_ptr<Slot>;

  // Prepare is at most so many layers ahead of anchor; even, as many parts alternate two layers.
  static constexpr uint64_t kLearnDelay = 32;

  // A layer's true start, and the next layer, if the end is chosen with a view to that.
  struct Place {
    Point start;
    SlotPtr next;
  };

  bool CleaningDueAfter(uint64_t index) const;
  std::optional<Point> FixedStart(const Slot& slot) const;
  Budget LayerBudget(const Slot& slot, double share) const;
  bool Expired() const;
  LayerProblem Problem(const Slot& slot, Point start) const;
  double AnchorShare() const;
  double SolveShare(const Slot& slot) const;
  bool MayLookAhead(const Slot& slot) const;
  bool LooksAheadAt(const Slot& slot, const Slot& next) const;

  // The stages.
  void Prepare(Slot& slot);
  Point PredictEnd(const Slot& slot);
  void SolveFirst(Slot& slot) const;
  void ResumeModel(const LayerProblem& problem, Slot& slot, Budget& budget) const;
  bool TakeOver(const KnownRoute& known, const LayerProblem& problem, const Slot& slot,
                Solution& solution) const;
  void SolveSecond(Slot& slot) const;
  LayerOutcome Anchor(Slot& slot, const Place& place) const;
  uint64_t KindAt(const Slot& slot, const Place& place) const;
  double CostInView(const LayerProblem& problem, const Route& route, const Slot* next) const;
  const Route& BestToGoOnFrom(const LayerProblem& problem, const Slot& slot,
                              const KnownRoute* known, const Slot* next) const;
  Solution SolveFromTrueStart(const LayerProblem& problem, const Slot& slot,
                              const KnownRoute* known, Slot*& next, Route& greedy) const;
  Route GreedyRoute(const LayerProblem& problem, const Slot& slot) const;
  bool GreedyMayBeBetter(const LayerProblem& problem, const Slot& slot, const KnownRoute* known,
                         const Slot* next) const;
  void KeepBestRoute(const LayerProblem& problem, const Slot& slot, const KnownRoute* known,
                     const Slot* next, Route greedy, Solution& solution) const;
  KnownRoutePtr Known(const LayerProblem& problem, const Slot& slot,
                      const Solution& solution) const;
  static const KnownRoute* FindAnchored(const Slot& slot, uint64_t kind);
  void Bound(const LayerProblem& problem, Slot& slot, Solution& solution) const;

  // Fixes what the layer may use of the job's time. As its main stage begins.
  void Allot(Slot& slot);

  // Run a stage and hand the layer over to the next one.
  void RunPrepare(const SlotPtr& slot);
  void RunSolveFirst(const SlotPtr& slot);
  void RunSolveSecond(const SlotPtr& slot);
  void RunAnchor(const SlotPtr& slot, const Place& place);

  // Submit what is due.
  void MaybePrepare() TRAVERSE_REQUIRES(mutex_);
  void MaybeSolveFirst(const SlotPtr& slot) TRAVERSE_REQUIRES(mutex_);
  void HandOn(const Slot& slot) TRAVERSE_REQUIRES(mutex_);
  void MaybeSolveSecond(uint64_t index) TRAVERSE_REQUIRES(mutex_);
  void MaybeAnchor(uint64_t index) TRAVERSE_REQUIRES(mutex_);
  void MaybeFinish() TRAVERSE_REQUIRES(mutex_);
  void Submit(std::function<void()> stage, int64_t points) TRAVERSE_REQUIRES(mutex_);
  void DropAnchored() TRAVERSE_REQUIRES(mutex_);
  const SlotPtr& SlotAt(uint64_t index) const TRAVERSE_REQUIRES(mutex_) {
    return slots_[index - first_index_];
  }

  const JobSpec spec_;
  const std::unique_ptr<Strategy> strategy_;
  const std::unique_ptr<Strategy> predictor_;
  Executor& executor_;
  CancelToken cancel_;
  Outbox outbox_;

  // Where the head is after the layers prepared so far; only prepare touches these.
  Point given_at_;
  Point predicted_at_;
  std::shared_ptr<Anchored> anchored_;
  EndHistory history_;

  mutable Mutex mutex_;
  BudgetSplit split_ TRAVERSE_GUARDED_BY(mutex_);
  RouteHistory routes_ TRAVERSE_GUARDED_BY(mutex_);
  std::deque<SlotPtr> slots_ TRAVERSE_GUARDED_BY(mutex_);  // [index - first_index_]
  uint64_t first_index_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  uint64_t added_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  uint64_t next_to_prepare_ TRAVERSE_GUARDED_BY(mutex_) = 0;

  // What prepare has not learned yet of anchored layers, by index. It learns of layer i -
  // kLearnDelay right before it prepares layer i: what it knows must not depend on timing.
  struct Lesson {
    uint64_t make = 0;
    uint64_t kind = 0;
    Point end;            // from the plan's origin
    KnownRoutePtr known;  // null where routes are not used again
  };
  std::map<uint64_t, Lesson> lessons_ TRAVERSE_GUARDED_BY(mutex_);
  int64_t pending_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int64_t tasks_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // submitted and not yet ended
  bool preparing_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool closed_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool finished_ TRAVERSE_GUARDED_BY(mutex_) = false;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_CHAIN_H_
