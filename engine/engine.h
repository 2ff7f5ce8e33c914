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
  int every_layers = 1;           // >= 1
  int layers_since_cleaning = 0;  // before the first layer; in [0, every_layers)
};

// What holds for a whole job.
struct JobSpec {
  Point start;
  std::optional<CleaningSpec> cleaning;
  CostSpec cost;
  uint64_t seed = 1;

  // The job's end, if it has one; then layers that are left come back as they are.
  std::optional<Budget::Clock::time_point> deadline;

  // Most time for one layer; absl::InfiniteDuration() for no limit.
  absl::Duration layer_time_limit = absl::InfiniteDuration();
};

// One layer of a job.
struct JobLayer {
  Plan plan;                     // passes CheckPlan
  std::optional<Point> start;    // unset: where the layer before ended
  std::optional<CostSpec> cost;  // unset: the job's

  // Add or Close is called again without waiting for this layer's answer: where the strategy looks
  // ahead, the answer waits for that, and the layer's end is chosen with the next layer in view.
  // False, as for a caller who sends on after an answer: it is not waited for.
  bool more_follows = false;

  // What moves by time should not cross; passes CheckWalls.
  LayerWalls walls = {};
};

// The answer for one layer.
struct LayerOutcome {
  uint64_t index = 0;  // position in the job, from 0
  Plan plan;           // as given
  Point start;
  Point end;
  Route route;  // valid: checked by the validator
  TravelSplit given;
  TravelSplit travel;
  double cost_given = 0;  // in the unit of the layer's cost; moves to the cleaning point apart
  double cost = 0;
  MoveCounts moves_given = {};
  MoveCounts moves = {};
  std::vector<Detour> detours = {};

  // No route from this start costs less, where a move to the cleaning point follows: none costs
  // less together with that move than this bound and this route's move.
  std::optional<double> lower_bound;
  double cleaning_given_mm = 0;  // move to the cleaning point after this layer
  double cleaning_mm = 0;
  StopReason stop = StopReason::kLocalOptimum;
  double solve_seconds = 0;
  std::map<std::string, double> statistics = {};  // Solution::statistics

  // Not empty: the strategy's route was invalid, for this reason, and the given order took its
  // place.
  std::string invalid_route;
};

// Receives the answers of one job. Calls never overlap; they come from threads of the executor.
class JobSink {
 public:
  virtual ~JobSink() = default;

  // A layer is done. Layers that start where the one before ended come in build order; a layer
  // whose start does not depend on the one before (after a cleaning, or given) may come before
  // earlier ones.
  virtual void OnLayer(LayerOutcome outcome) = 0;

  // Last call: all layers of a closed job were delivered, or the job was cancelled.
  virtual void OnDone() = 0;
};

// A job under way. Thread-safe.
class Job {
 public:
  // `executor` and `sink` outlive the job's last call of OnDone. `strategy` is shared by all
  // layers.
  static std::shared_ptr<Job> Start(const JobSpec& spec, std::unique_ptr<Strategy> strategy,
                                    Executor& executor, JobSink& sink);

  virtual ~Job() = default;

  // Adds the next layer. REQUIRES: not closed.
  virtual void Add(JobLayer layer) = 0;

  // There are no more layers. OnDone follows when all are answered, possibly within this call's
  // time.
  virtual void Close() = 0;

  // Stops the work within 50 ms: layers not yet delivered are dropped and OnDone follows. May be
  // called at any time, more than once.
  virtual void Cancel() = 0;

  // The number of layers added and not yet delivered, for callers that bound it.
  virtual int64_t pending() const = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_ENGINE_H_
