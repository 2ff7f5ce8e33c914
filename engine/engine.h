// The engine: routes for the layers of a job. What the server calls.
//
//   auto strategy = MakeStrategy("ni2opt", {});
//   JobSpec spec;                                  // start, cleaning, cost, limits
//   auto job = Job::Start(spec, *std::move(strategy), executor, sink);
//   job->Add({.plan = plan});                      // as layers come, in build order
//   job->Close();                                  // sink->OnLayer(...) for each, then
//   sink->OnDone()

#ifndef TRAVERSE_ENGINE_ENGINE_H_
#define TRAVERSE_ENGINE_ENGINE_H_

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "engine/base/budget.h"
#include "engine/base/executor.h"
#include "engine/model/cost_spec.h"
#include "engine/model/links.h"
#include "engine/model/moves.h"
#include "engine/model/plan.h"
#include "engine/model/route.h"
#include "engine/model/travel_split.h"
#include "engine/model/walls.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// Nozzle cleaning, SPEC section 2.
struct CleaningSpec {
  Point point;
  int every_layers = 1;           // at least 1
  int layers_since_cleaning = 0;  // printed before the first layer; in [0, every_layers)
};

// What a job sets for all of its layers.
struct JobSpec {
  Point start;
  std::optional<CleaningSpec> cleaning;
  CostSpec cost;
  uint64_t seed = 1;

  // When the job must end. The search ends as long before as greedy needs for the layers that are
  // not yet answered (schedule/budget_split.h). Unset: never.
  std::optional<Budget::Clock::time_point> deadline;

  // Longest time for one layer; absl::InfiniteDuration() for no limit.
  absl::Duration layer_time_limit = absl::InfiniteDuration();

  // The clock of these limits; null: the steady clock. Outlives the job.
  const TimeSource* time = nullptr;
};

// One layer of a job.
struct JobLayer {
  Plan plan;                     // passes CheckPlan
  std::optional<Point> start;    // unset: where the layer before ended
  std::optional<CostSpec> cost;  // unset: the job's

  // If true, Add or Close will be called again without waiting for this layer's answer. A strategy
  // that looks ahead then waits for that call, and ends the layer where the next one is cheap to
  // begin. If false, answer without waiting for the next layer.
  bool more_follows = false;

  // Walls that travel should not cross if the cost is a time; passes CheckWalls.
  LayerWalls walls = {};

  // What lies between its paths besides moves; LinksFit for `plan`. The search knows none of it:
  // its route is improved by this cost at the end (schedule/layer_solver_links.cc).
  LayerLinks links = {};

  // A route of the plan that is known beforehand; empty if there is none. The strategy begins with
  // it if it is no worse than greedy's, and the answer never costs more than it does from the same
  // start. REQUIRES: FindRouteFault finds nothing in it.
  Route initial_route = {};
};

// The answer for one layer.
struct LayerOutcome {
  uint64_t index = 0;  // position in the job, from 0
  Plan plan;           // as given
  Point start;
  Point end;              // where travel to the next layer begins
  LinkSeconds departure;  // what it takes to get there from the last path
  Route route;            // valid: checked by the validator
  TravelSplit given;
  TravelSplit travel;
  double cost_given = 0;  // in the unit of the layer's cost, without moves to the cleaning point
  double cost = 0;
  MoveCounts moves_given = {};
  MoveCounts moves = {};
  std::vector<Detour> detours = {};

  // A lower bound: no route from this start costs less. If a move to the cleaning point follows, no
  // route together with that move costs less than this bound plus the found route's own move.
  std::optional<double> lower_bound;
  double cleaning_given_mm = 0;  // length of the move to the cleaning point after this layer
  double cleaning_mm = 0;
  StopReason stop = StopReason::kLocalOptimum;
  double solve_seconds = 0;
  std::map<std::string, double> statistics = {};  // Solution::statistics

  // If not empty, the strategy's route was invalid for this reason, and the given order replaced
  // it.
  std::string invalid_route;
};

// Receives the answers of one job. Calls never overlap. They come from threads of the executor.
class JobSink {
 public:
  virtual ~JobSink() = default;

  // A layer is done. Layers that start where the one before ended come in build order.
  // A layer whose start is given, or follows a cleaning, may come before earlier
  // layers.
  virtual void OnLayer(LayerOutcome outcome) = 0;

  // No routes of all layers together cost less than this, in the unit of their costs, without moves
  // to the cleaning point as in LayerOutcome::lower_bound. Comes at most once, after all layers, if
  // the strategy bounds the chain.
  virtual void OnChainBound(double /*lower_bound*/) {}

  // The last call: all layers of a closed job were delivered, or the job was cancelled.
  virtual void OnDone() = 0;
};

// A running job. Thread-safe.
class Job {
 public:
  // Starts a job. `executor` and `sink` must outlive the job's call of OnDone. All layers share
  // `strategy`.
  static std::shared_ptr<Job> Start(const JobSpec& spec, std::unique_ptr<Strategy> strategy,
                                    Executor& executor, JobSink& sink);

  virtual ~Job() = default;

  // Says that a layer with this plan will be added, after those announced before, so that time is
  // kept for it. A job whose end is not announced keeps as much time for what may come as for what
  // it knows.
  virtual void Announce(const Plan& plan) = 0;

  // Says that no layers follow but those added or announced. Close says so too.
  virtual void AnnounceEnd() = 0;

  // Adds the next layer. REQUIRES: not closed.
  virtual void Add(JobLayer layer) = 0;

  // Says that no more layers follow. OnDone comes when all are answered, possibly before this call
  // returns.
  virtual void Close() = 0;

  // Stops the work within 50 ms: drops the layers not yet delivered, then calls OnDone. May be
  // called at any time, more than once.
  virtual void Cancel() = 0;

  // The number of layers added but not yet delivered, for callers that bound it.
  virtual int64_t pending() const = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_ENGINE_H_
