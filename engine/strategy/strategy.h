// A strategy: a method that finds a route for one layer.

#ifndef TRAVERSE_ENGINE_STRATEGY_STRATEGY_H_
#define TRAVERSE_ENGINE_STRATEGY_STRATEGY_H_

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/strategy/options/options.h"

namespace traverse {

// What a strategy found.
struct Solution {
  Route route;
  StopReason stop = StopReason::kLocalOptimum;

  // No route of the problem costs less, in the unit of its cost, `finish` included. Unset: unknown.
  std::optional<double> lower_bound;

  // What the search can tell of itself, by name; what there is depends on the strategy. Names that
  // end in _cost, _value or _bound are in the unit of the problem's cost.
  std::map<std::string, double> statistics = {};
};

// What the chain of layers has to know of a strategy to call it as it is meant.
struct StrategyTraits {
  // Layers are solved one after another, each from its true start alone: where Solve takes no
  // longer than a prediction of the start would, or where what is found for a predicted start is
  // worth nothing at another one.
  bool serial = false;

  // Callers want the route of this method alone, however long: no other one, such as greedy's or
  // the order given, takes its place.
  bool pure = false;

  // Solve is so quick that the chain may solve a layer again where its start was predicted wrongly,
  // instead of resuming: the routes are then those of solving one layer after another.
  bool quick = false;

  // Resume may take the place of Solve where a route of an equal layer is known.
  bool reuses_routes = false;

  // Callers want a lower bound of solutions that have none: the chain looks for one then, with so
  // much effort (LowerBound). 0: they want none.
  double bound_effort = 0;

  // Two layers of at most so many paths together are worth ResumeWithNext: the chain calls it
  // where the next layer is known. 0: it does no more than Resume.
  size_t look_ahead_paths = 0;
};

// A strategy set up for one plan. It keeps what it derives of the plan from one call to the next,
// so solving the plan again, from another start, takes less time. The solutions are those of the
// strategy itself. Not thread-safe: one call at a time.
class PreparedLayer {
 public:
  virtual ~PreparedLayer() = default;

  // As those of Strategy. REQUIRES: problem.plan is the plan that was prepared.
  virtual Solution Solve(const LayerProblem& problem, Budget& budget) = 0;
  virtual Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) = 0;
  virtual Solution ResumeWithNext(const LayerProblem& problem, const Route& start,
                                  const LayerProblem& next, Route& next_start, Budget& budget) = 0;
};

// One method with the options of one job. Immutable after construction, so that layers may be
// solved by several threads at once.
class Strategy {
 public:
  explicit Strategy(const StrategyTraits& traits = {}) : traits_(traits) {}
  virtual ~Strategy() = default;

  const StrategyTraits& traits() const { return traits_; }

  // A valid route, always: when the budget runs out, the best so far, at worst the given order,
  // with stop kTimeLimit or kCancelled. The same problem gives the same solution unless the budget
  // ended it.
  virtual Solution Solve(const LayerProblem& problem, Budget& budget) const = 0;

  // Improves `start`, a valid route of `problem`; never returns a worse one. The chain of layers
  // calls it when a layer that was solved from a predicted start turns out to begin elsewhere, so
  // it has to be much quicker than Solve, and its quality is that of Solve. The default solves
  // again.
  virtual Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const;

  // Improves `start` together with `next_start`, a route of `next`, the layer done after this one.
  // That begins where this one ends; its own start is not looked at. The two never get worse
  // together. The solution is that of `problem` alone, and so is its bound: a route that ends
  // elsewhere for the sake of the next layer is not optimal. The default leaves `next_start` as it
  // is and resumes. REQUIRES: both have the same cost; problem.finish is unset.
  virtual Solution ResumeWithNext(const LayerProblem& problem, const Route& start,
                                  const LayerProblem& next, Route& next_start,
                                  Budget& budget) const;

  // For a plan that is solved more than once. The plan and this strategy outlive what is returned.
  // The default keeps nothing of the plan.
  virtual std::unique_ptr<PreparedLayer> Prepare(const Plan& plan) const;

 private:
  const StrategyTraits traits_;
};

// A strategy that solves each problem with a PreparedLayer, if need be one for this call alone.
class PreparingStrategy : public Strategy {
 public:
  using Strategy::Strategy;

  std::unique_ptr<PreparedLayer> Prepare(const Plan& plan) const override = 0;

  Solution Solve(const LayerProblem& problem, Budget& budget) const final;
  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const final;
  Solution ResumeWithNext(const LayerProblem& problem, const Route& start, const LayerProblem& next,
                          Route& next_start, Budget& budget) const final;
};

// A row of the registry: what there is to know about a strategy without running it.
struct StrategyEntry {
  std::string name;
  std::string summary;       // what it does and promises, in a sentence
  bool lower_bound = false;  // whether solutions may carry one
  std::vector<OptionSpec> options;
  std::unique_ptr<Strategy> (*make)(const StrategyOptions& options);
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_STRATEGY_H_
