// A strategy: a method that finds a route for one layer.

#ifndef TRAVERSE_ENGINE_STRATEGY_STRATEGY_H_
#define TRAVERSE_ENGINE_STRATEGY_STRATEGY_H_

#include <cstddef>
#include <limits>
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

  // No route of the problem costs less, in its unit and including `finish`. Unset: unknown.
  std::optional<double> lower_bound;

  // Figures of the search, by name; which ones depends on the strategy. Names that end in _cost,
  // _value or _bound are in the unit of the problem's cost.
  std::map<std::string, double> statistics = {};

  // About what the search took, by counts of its work: the same on every machine. 0: unknown.
  double counted_seconds = 0;
};

// A layer that is done after others: it begins where the one before it ends, so `problem.start` is
// ignored.
struct NextLayer {
  LayerProblem problem;
  Route route;  // of the problem
};

// What the chain of layers must know to call a strategy properly.
struct StrategyTraits {
  // Solve layers one after another, each only from its true start: because Solve is no slower than
  // predicting the start, or because a route for a predicted start is worth nothing at another
  // one.
  bool serial = false;

  // Callers want the route of this method alone, however long. No other route, such as greedy's or
  // the given order, replaces it.
  bool pure = false;

  // Solve is so quick that the chain may solve a layer again, instead of resuming, if its start was
  // predicted wrongly. The routes are then those of solving one layer after another.
  bool quick = false;

  // Resume may replace Solve if a route of an equal layer is known.
  bool reuses_routes = false;

  // Callers want a lower bound for solutions without one. The chain then computes one, with this
  // effort (LowerBound). 0: they want none.
  double bound_effort = 0;

  // The most that a bound may take of what the search has taken (Solution::counted_seconds).
  double bound_of_search = std::numeric_limits<double>::infinity();

  // Whether callers want a lower bound of all layers together, which the chain computes at the end:
  // by LowerBound, or by Resume where that proves one.
  enum class ChainBounding { kNone, kQuick, kByResume };
  ChainBounding chain_bounding = ChainBounding::kNone;

  // Two layers with at most this many paths together are worth ResumeWithNext, which the chain
  // calls if it knows the next layer. 0: it does no more than Resume.
  size_t look_ahead_paths = 0;

  // More than two layers are worth it with at most this many paths together.
  size_t look_further_paths = 0;

  // Solve takes more time than greedy, so that it may be cut short.
  bool searches = true;
};

// Of strategies that prove nothing themselves.
inline StrategyTraits::ChainBounding QuickChainBounding(bool wanted) {
  return wanted ? StrategyTraits::ChainBounding::kQuick : StrategyTraits::ChainBounding::kNone;
}

// A strategy set up for one plan. It keeps what it derives from the plan between calls, so solving
// the plan again from another start takes less time. The solutions are those of the strategy
// itself. Not thread-safe: one call at a time.
class PreparedLayer {
 public:
  virtual ~PreparedLayer() = default;

  // As in Strategy. REQUIRES: problem.plan is the plan that was prepared.
  virtual Solution Solve(const LayerProblem& problem, Budget& budget) = 0;
  virtual Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) = 0;
  virtual Solution ResumeWithNext(const LayerProblem& problem, const Route& start,
                                  std::vector<NextLayer>& next, Budget& budget) = 0;
};

// One method with the options of one job. Immutable after construction, so that several threads may
// solve layers at once.
class Strategy {
 public:
  explicit Strategy(const StrategyTraits& traits = {}) : traits_(traits) {}
  virtual ~Strategy() = default;

  const StrategyTraits& traits() const { return traits_; }

  // Always returns a valid route: when the budget runs out the best so far, with stop kTimeLimit or
  // kCancelled. It may cost more than greedy's then: the chain of layers keeps time for that one.
  // The same problem gives the same solution, unless the budget ended it.
  virtual Solution Solve(const LayerProblem& problem, Budget& budget) const = 0;

  // Improves `start`, a valid route of `problem`; never returns a worse one. The chain of
  // layers calls it when a layer that was solved from a predicted start turns out to begin
  // elsewhere. So it must be much quicker than Solve, with the same quality. By default it
  // solves again.
  virtual Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const;

  // Improves `start` together with the routes of `next`, the layers after this one. All of them
  // together never get worse. The solution, and so its bound, is that of `problem` alone: a route
  // that ends elsewhere for the sake of the next layers is not optimal. By default it leaves `next`
  // as it is and resumes.
  // REQUIRES: `next` is not empty; all have the same cost; only the last may have a finish; where
  // there are walls, `next` is one layer.
  virtual Solution ResumeWithNext(const LayerProblem& problem, const Route& start,
                                  std::vector<NextLayer>& next, Budget& budget) const;

  // For a plan that is solved more than once. The plan and this strategy must outlive the result.
  // By default it keeps nothing of the plan.
  virtual std::unique_ptr<PreparedLayer> Prepare(const Plan& plan) const;

 private:
  const StrategyTraits traits_;
};

// A strategy that solves each problem with a PreparedLayer, created for the call if necessary.
class PreparingStrategy : public Strategy {
 public:
  using Strategy::Strategy;

  std::unique_ptr<PreparedLayer> Prepare(const Plan& plan) const override = 0;

  Solution Solve(const LayerProblem& problem, Budget& budget) const final;
  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const final;
  Solution ResumeWithNext(const LayerProblem& problem, const Route& start,
                          std::vector<NextLayer>& next, Budget& budget) const final;
};

// A row of the registry: what can be known about a strategy without running it.
struct StrategyEntry {
  std::string name;
  std::string summary;       // what it does and promises, in a sentence
  bool lower_bound = false;  // whether solutions may carry one
  std::vector<OptionSpec> options;
  std::unique_ptr<Strategy> (*make)(const StrategyOptions& options);
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_STRATEGY_H_
