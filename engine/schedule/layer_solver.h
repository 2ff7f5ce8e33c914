// What is done with one layer at a time; layer_chain.h says when.

#ifndef TRAVERSE_ENGINE_SCHEDULE_LAYER_SOLVER_H_
#define TRAVERSE_ENGINE_SCHEDULE_LAYER_SOLVER_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/cost/route_cost.h"
#include "engine/engine.h"
#include "engine/schedule/chain_bound.h"
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

  // Most layers behind a layer that it is ended in view of.
  static constexpr size_t kMostInView = 4;

  // Whether it may pay to have one more layer in view than `view`, if there is one.
  bool MayLookAhead(const ChainLayer& layer, const LayersInView& view) const;

  // Whether that may be `next`, the layer behind those.
  bool LooksAheadAt(const ChainLayer& layer, const LayersInView& view,
                    const ChainLayer& next) const;

  // True if no time is left to search the layer. It is then answered with the best of what there is
  // and greedy's route.
  bool Expired(const ChainLayer& layer) const;

  // For work that must be done regardless of time: other tasks get their turns meanwhile, and a
  // cancellation is seen.
  Budget Turns() const { return Budget(&cancel_, std::nullopt, executor_.turn(), spec_.time); }

  // Whether the clock may end a search, so that layers need greedy's routes to fall back on.
  bool MayBeCutShort() const;

  // The problem of solving the layer from `start`. Refers to `layer`.
  LayerProblem Problem(const ChainLayer& layer, Point start) const;

  // The cost that the caller asks for; searches have ChainLayer::cost.
  const CostSpec& TrueCost(const ChainLayer& layer) const {
    return layer.given.cost ? *layer.given.cost : spec_.cost;
  }

  // Whether links cost more than moves in the layer, to whose start the head came in `departure`.
  static bool IsLinked(const ChainLayer& layer, const LinkSeconds& departure) {
    return !layer.given.links.empty() || departure != LinkSeconds();
  }

  // The problem with all that links cost; the head came to its start as `before` says, whose `from`
  // is set. Refers to `layer`.
  LayerProblem LinkedProblem(const ChainLayer& layer, const Departure& before) const;

  // Where the head is after the layer, cleaning included, if it is done as it was found alone.
  static Point EndAlone(const ChainLayer& layer) { return layer.finish.value_or(layer.alone->end); }

  // The same if it is done by `route` from `start`.
  static Point EndOf(const ChainLayer& layer, const Route& route, Point start) {
    return layer.finish.value_or(RouteEnd(layer.given.plan, route, start));
  }

  // Returns the route of greedy's chain if that begins the layer here; else searches, in the time
  // that is kept for it, besides that of any search. Like measuring and checking a route it is done
  // although the deadline has passed, for as many points as take less time than a
  // busy machine may stop the thread for.
  Route GreedyRoute(const LayerProblem& problem, const ChainLayer& layer) const;

  // Whether the route that the caller knows is worth beginning with: greedy's costs no less. Those
  // that do not search begin with any.
  bool ResumesInitial(const LayerProblem& problem, const ChainLayer& layer) const;

  // `solution` with what later layers need to continue from it.
  KnownRoutePtr Known(const LayerProblem& problem, const ChainLayer& layer,
                      const Solution& solution) const;

  // The stages. ChainLayer says what each sets.
  void SolveFirst(ChainLayer& layer) const;
  void SolveSecond(ChainLayer& layer) const;
  void SolveAlone(ChainLayer& layer, Point start) const;
  LayerOutcome Anchor(ChainLayer& layer, const TrueStart& at) const;

  // A lower bound of all layers together, once they are done. `layers`: how many there are.
  std::optional<double> BoundChain(const ChainBound& chain, uint64_t layers,
                                   Budget::Clock::duration allotted) const;

 private:
  PreparedLayer& Prepared(ChainLayer& layer) const {
    if (!layer.prepared) layer.prepared = strategy_->Prepare(layer.given.plan);
    return *layer.prepared;
  }
  Budget BudgetWithin(std::optional<Budget::Clock::time_point> end,
                      Budget::Clock::duration allotted, double layer_limits, double share) const;
  Budget LayerBudget(const ChainLayer& layer, double share) const;
  double AnchorShare() const;
  double SolveShare(const ChainLayer& layer) const;
  Solution SolveOrResume(const LayerProblem& problem, ChainLayer& layer, Budget& budget) const;
  const Route* RouteOfPrecursor(const LayerProblem& problem, const ChainLayer& layer,
                                Budget& budget) const;
  void ResumeFromPrecursor(const LayerProblem& problem, ChainLayer& layer, Budget& budget) const;
  bool TakeOver(const KnownRoute& known, const LayerProblem& problem, const ChainLayer& layer,
                Solution& solution) const;
  uint64_t KeyAt(const ChainLayer& layer, const TrueStart& at) const;
  static const Solution* FoundFrom(const ChainLayer& layer, Point start);
  Budget BudgetFromTrueStart(const ChainLayer& layer) const;
  const Route& BestToGoOnFrom(const LayerProblem& problem, const ChainLayer& layer,
                              const KnownRoute* known) const;
  Solution SolveFromTrueStart(const LayerProblem& problem, ChainLayer& layer,
                              const KnownRoute* known, const TrueStart& at) const;
  Solution ValidFromTrueStart(const LayerProblem& problem, ChainLayer& layer,
                              const KnownRoute* known, const TrueStart& at) const;
  // In layer_solver_floor.cc: greedy's route and the one known beforehand, which no answer exceeds.
  bool GreedyMayBeBetter(const LayerProblem& problem, const ChainLayer& layer,
                         const KnownRoute* known, const Solution& solution) const;
  bool KeepWithinGreedy(const LayerProblem& problem, const ChainLayer& layer, const TrueStart& at,
                        Solution& solution) const;
  double MostOverGreedyFrom(Point end, const ChainLayer& layer, const TrueStart& at) const;
  double MostOverGreedyFrom(Point end, const ChainLayer& layer, bool is_followed,
                            const ChainLayer* next) const;
  void KeepBestRoute(const LayerProblem& problem, const ChainLayer& layer, const KnownRoute* known,
                     const LayersInView& view, Solution& solution) const;
  bool KeepWithinInitial(const LayerProblem& problem, const ChainLayer& layer,
                         Solution& solution) const;
  // In layer_solver_links.cc.
  void ImproveLinked(const LayerProblem& linked, const ChainLayer& layer, Solution& solution) const;
  bool ProveLinked(const LayerProblem& linked, const ChainLayer& layer, Solution& solution) const;
  void BoundLinked(const LayerProblem& linked, const ChainLayer& layer, Solution& solution) const;
  const KnownRoute* FindAnchored(const ChainLayer& layer, const AnchoredRoutes::ByKey& routes,
                                 uint64_t key) const;
  void Bound(const LayerProblem& problem, ChainLayer& layer, Solution& solution) const;

  // In layer_solver_ahead.cc: a layer and those in view, as they are done one after the other.
  struct RoutesInView {
    Route route;
    std::vector<NextLayer> next;
    double cost = 0;  // of all
  };
  size_t MostPathsInView(const LayersInView& view) const;
  template <typename RouteOf>
  RoutesInView InView(const LayerProblem& problem, const Route& route, const TrueStart& at,
                      const RouteOf& route_of) const;
  std::vector<RoutesInView> KnownInView(const LayerProblem& problem, const Route& found,
                                        ChainLayer& layer, const TrueStart& at, bool initial,
                                        Budget& budget) const;
  void SolveInView(const LayerProblem& problem, ChainLayer& layer, const TrueStart& at,
                   Budget& budget, Solution& solution) const;

  // The cost of the route, and of what is foreseen of the next layer, if one is in view, from its
  // end.
  double CostInView(const LayerProblem& problem, const Route& route,
                    const LayersInView& view) const;

  // In layer_solver_alone.cc: what keeps the job from becoming longer by looking ahead.
  struct Return {
    double over = 0;           // what the job then costs more than one layer after the other
    size_t foreseen = 0;       // how many layers in view are done as foreseen before
    bool by_way_back = false;  // whether the one after these is done by its way back
  };
  void FindWayBack(const LayerProblem& problem, const Route& route, const TrueStart& at,
                   Budget& budget) const;
  static bool KnowsAlone(const ChainLayer& layer, const TrueStart& at);
  static const Route& FallbackRoute(const ChainLayer& layer) {
    return layer.fallback.empty() ? layer.alone->solution.route : layer.fallback;
  }
  std::optional<Return> CheapestReturn(const LayerProblem& problem, const Route& route,
                                       const ChainLayer& layer, const TrueStart& at) const;
  bool LeadsBack(const LayerProblem& problem, const Route& route, const ChainLayer& layer,
                 const TrueStart& at) const;
  bool KeepWithinAlone(const LayerProblem& problem, const ChainLayer& layer, const TrueStart& at,
                       Solution& solution) const;

  const JobSpec spec_;
  const std::unique_ptr<Strategy> strategy_;
  const std::unique_ptr<Strategy> predictor_;
  Executor& executor_;
  const CancelToken& cancel_;

  // Points of the job for which greedy may still run after the deadline: at 0.5 us, 50 ms.
  static constexpr int64_t kMostLatePoints = 100'000;
  mutable std::atomic<int64_t> late_points_left_ = kMostLatePoints;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_SOLVER_H_
