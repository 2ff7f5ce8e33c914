// What is done with one layer at a time; layer_chain.h says when.

#ifndef TRAVERSE_ENGINE_SCHEDULE_LAYER_SOLVER_H_
#define TRAVERSE_ENGINE_SCHEDULE_LAYER_SOLVER_H_

#include <cstdint>
#include <memory>
#include <optional>

#include "engine/base/budget.h"
#include "engine/engine.h"
#include "engine/schedule/chain_layer.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// The stages of the layers of one job. Each works on one layer, alone and without a lock. Several
// layers may be at their stages at the same time, on several threads.
class LayerSolver {
 public:
  // Keeps, but does not own, `executor` and `cancel`.
  LayerSolver(const JobSpec& spec, std::unique_ptr<Strategy> strategy, Executor& executor,
              const CancelToken& cancel);

  const StrategyTraits& traits() const { return strategy_->traits(); }

  // Whether the head goes to the cleaning point after this layer, if another layer follows.
  bool CleaningDueAfter(uint64_t index) const;

  // The start, if it does not depend on the layer before.
  std::optional<Point> FixedStart(const ChainLayer& layer) const;

  // Whether it may pay to choose the layer's end for the next layer's sake, if there is one.
  bool MayLookAhead(const ChainLayer& layer) const;

  // Whether it pays to do so for `next`.
  bool LooksAheadAt(const ChainLayer& layer, const ChainLayer& next) const;

  // True if time is up, so that the layer must be answered with what there is.
  bool Expired() const;

  // For work that must be done regardless of time: other tasks get their turns meanwhile, and a
  // cancellation is seen.
  Budget Turns() const { return Budget(&cancel_, std::nullopt, executor_.turn()); }

  // The problem of solving the layer from `start`. Refers to `layer`.
  LayerProblem Problem(const ChainLayer& layer, Point start) const;

  Route GreedyRoute(const LayerProblem& problem, const ChainLayer& layer) const;

  // `solution` with what later layers need to continue from it.
  KnownRoutePtr Known(const LayerProblem& problem, const ChainLayer& layer,
                      const Solution& solution) const;

  // The stages. ChainLayer says what each sets.
  void SolveFirst(ChainLayer& layer) const;
  void SolveSecond(ChainLayer& layer) const;
  LayerOutcome Anchor(ChainLayer& layer, const TrueStart& at) const;

 private:
  PreparedLayer& Prepared(ChainLayer& layer) const {
    if (!layer.prepared) layer.prepared = strategy_->Prepare(layer.given.plan);
    return *layer.prepared;
  }
  Budget LayerBudget(const ChainLayer& layer, double share) const;
  double AnchorShare() const;
  double SolveShare(const ChainLayer& layer) const;
  void ResumeFromPrecursor(const LayerProblem& problem, ChainLayer& layer, Budget& budget) const;
  bool TakeOver(const KnownRoute& known, const LayerProblem& problem, const ChainLayer& layer,
                Solution& solution) const;
  uint64_t KeyAt(const ChainLayer& layer, const TrueStart& at) const;
  double CostInView(const LayerProblem& problem, const Route& route, const ChainLayer* next) const;
  const Route& BestToGoOnFrom(const LayerProblem& problem, const ChainLayer& layer,
                              const KnownRoute* known, const ChainLayer* next) const;
  Solution SolveFromTrueStart(const LayerProblem& problem, ChainLayer& layer,
                              const KnownRoute* known, ChainLayer*& next, Route& greedy) const;
  void SolveWithNext(const LayerProblem& problem, ChainLayer& layer, ChainLayer*& next,
                     Route& greedy, Budget& budget, Solution& solution) const;
  bool GreedyMayBeBetter(const LayerProblem& problem, const ChainLayer& layer,
                         const KnownRoute* known, const ChainLayer* next) const;
  void KeepBestRoute(const LayerProblem& problem, const ChainLayer& layer, const KnownRoute* known,
                     const ChainLayer* next, Route greedy, Solution& solution) const;
  const KnownRoute* FindAnchored(const ChainLayer& layer, uint64_t key) const;
  void Bound(const LayerProblem& problem, ChainLayer& layer, Solution& solution) const;

  const JobSpec spec_;
  const std::unique_ptr<Strategy> strategy_;
  const std::unique_ptr<Strategy> predictor_;
  Executor& executor_;
  const CancelToken& cancel_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_SOLVER_H_
