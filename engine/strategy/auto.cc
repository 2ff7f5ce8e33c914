#include "engine/strategy/auto.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/rng.h"
#include "engine/base/tolerances.h"
#include "engine/cost/layer_view.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/route_entries.h"
#include "engine/cost/wall_cost.h"
#include "engine/model/layers_in_order.h"
#include "engine/proof/small_parts/small_parts.h"
#include "engine/search/end_groups.h"
#include "engine/search/entries/leaf_entries.h"
#include "engine/search/greedy/greedy.h"
#include "engine/search/iterated_search.h"
#include "engine/search/long/long_search.h"
#include "engine/search/order_tree.h"
#include "engine/search/search_state.h"
#include "engine/strategy/auto_settings.h"
#include "engine/strategy/stop.h"

namespace traverse {
namespace {

// Iterations without a gain worth mentioning after which the search ends: so many, which more
// effort does not raise, and so many more a path (auto_settings.h).
constexpr double kLeastPatience = 150;
constexpr double kLeastGain = 2e-4;

// A search of more effort is divided into walks: the first one is of so much effort, the others end
// after so many iterations a path.
constexpr double kLongEffort = 4;
constexpr double kFirstWalkEffort = 1;
constexpr double kWalkPatience = 0.6;

// Paths times leaves between the cuts of the widest kicks.
constexpr int kWidestKicks = 200'000;
constexpr int kMostSpan = 400;
constexpr int kLeastMostSpan = 50;

// Of kicks, where the caller does not want so much of each iteration that there is no time for
// them: sliced files gain nothing by them, nor by a choice among double bridges.
constexpr double kLongShare = 0.3;
constexpr int kBridges = 3;

// Operations of dynamic programmes on small parts, by the way of 2 ns each; where walls are asked
// about, of ten times as much.
constexpr double kSmallPartOperations = 3e6;
constexpr double kSmallPartOperationsAmongWalls = 3e5;

// Of a search that starts from a route that was good from another start.
constexpr double kResumeShare = 0.4;

// How much more than the last iterations all of them have to gain, each on the average; of a search
// of less effort so much more.
constexpr double kEarned = 12;

// Layers of so many paths together are searched ahead; of fewer where the caller wants so much of
// each iteration that there is no time for it.
constexpr size_t kLookAheadPaths = 20'000;
constexpr size_t kLookAheadPathsInHaste = 64;
constexpr size_t kLookFurtherPaths = 150;

// Of more paths together, only those near the border are kicked: so many of each layer. Of fewer,
// searches take so little time that more effort is well worth it, up to so many times as much;
// unless the time counts: a search of all layers in view is what the layers behind them wait for.
constexpr size_t kPathsSearchedTogether = 400;
constexpr size_t kPathsSearchedTogetherInTime = 100;
constexpr int kKickedAtBorder = 50;
constexpr double kMostEffortOnFew = 4;

// What depends on the plan alone: most of what is done before a search begins.
struct DerivedOfPlan {
  DerivedOfPlan(const CompiledPlan& plan, const LeafEntries& entries, Budget& budget)
      : tree(plan, &budget), groups(entries, &budget) {}

  const OrderTree tree;
  const EndGroups groups;
  std::optional<NeighborLists> neighbors;
  bool complete = false;  // the neighbors
};

using PointPairs = std::vector<std::pair<Point, Point>>;

// The plan with all points moved by the least that there is, so that they are no points of another
// layer, and each new point with the one it stands for.
Plan SetApart(Plan plan, PointPairs& points) {
  for (Path& path : plan.paths) {
    for (Point& point : path.points) {
      const Point meant = point;
      point.x = std::nextafter(point.x, kMaxCoordinateMm * 2);
      points.emplace_back(point, meant);
    }
  }
  return plan;
}

struct AutoOptions {
  double effort = 1;
  double least_gain_each = 0;
  int64_t gain_window = 200;
  double idle_speed_mm_s = 0;  // 0: unknown
};

class AutoLayer : public PreparedLayer {
 public:
  // `plan` outlives it.
  AutoLayer(const AutoOptions& options, const Plan& plan)
      : options_(options), plan_(plan), settings_(SettingsFor(plan)) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) override {
    const LayerView layer(problem, &budget);
    return Search(layer, BaselineRoute(layer, budget), {options_.effort, options_.effort}, budget);
  }

  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) override {
    const double effort = options_.effort * kResumeShare;
    return Search(LayerView(problem, &budget), start, {effort, effort, effort >= 1}, budget);
  }

  Solution ResumeWithNext(const LayerProblem& problem, const Route& start,
                          std::vector<NextLayer>& next, Budget& budget) override {
    assert(problem.plan == &plan_ && !next.empty());
    const bool has_walls = problem.walls != nullptr || next.front().problem.walls != nullptr;
    assert(!has_walls || next.size() == 1);
    if (has_walls && problem.walls_unit != 1) return Resume(problem, start, budget);
    PointPairs second_points;
    const Plan second_apart =
        has_walls ? SetApart(*next.front().problem.plan, second_points) : Plan();
    std::vector<const Plan*> plans = {problem.plan};
    std::vector<const Route*> routes = {&start};
    for (const NextLayer& layer : next) {
      plans.push_back(has_walls ? &second_apart : layer.problem.plan);
      routes.push_back(&layer.route);
    }
    const Plan plan = PlanInOrder(plans);
    const WallCost walls(problem.walls, next.front().problem.walls, second_points, problem.cost);
    LayerProblem all = problem;
    all.plan = &plan;
    all.walls = has_walls ? &walls : nullptr;
    all.finish = next.back().problem.finish;
    AutoLayer joined(options_, plan);
    Solution solution = joined.Search(LayerView(all, &budget), RouteInOrder(routes),
                                      EffortOnAll(problem, plan), budget);
    std::vector<Route> found = RoutesOfEach(plans, solution.route);
    for (size_t i = 0; i < next.size(); ++i) next[i].route = std::move(found[i + 1]);
    solution.route = std::move(found.front());
    ProveIfSmall(problem, solution, budget);
    return solution;
  }

 private:
  struct Effort {
    double kicks;
    double small_parts;
    bool detours = true;  // whether worse routes are walked through: too far for a short search

    // Positions near which kicks are.
    int first_kicked = 1;
    int last_kicked = std::numeric_limits<int>::max();
  };

  // On a layer and those behind it. What large layers are on their own they are already: there only
  // what is near the border is worth a search.
  Effort EffortOnAll(const LayerProblem& problem, const Plan& all) const {
    const bool time_counts = options_.idle_speed_mm_s > 0;
    const size_t together = time_counts ? kPathsSearchedTogetherInTime : kPathsSearchedTogether;
    const double share = static_cast<double>(together) / static_cast<double>(all.paths.size());
    const double most = time_counts ? 1 : kMostEffortOnFew;
    const bool in_haste = options_.least_gain_each > 0;
    const bool is_short = in_haste || problem.is_searched;
    Effort effort{options_.effort * (is_short ? kResumeShare : std::clamp(share, 1.0, most)),
                  options_.effort * 2 * kResumeShare, !problem.is_searched};
    if (share >= 1) return effort;
    const int border = static_cast<int>(problem.plan->paths.size());  // its last path's position
    effort.first_kicked = std::max(1, border + 1 - kKickedAtBorder);
    effort.last_kicked = border + kKickedAtBorder;
    return effort;
  }

  // REQUIRES: the layer's plan is the one that was prepared.
  Solution Search(const LayerView& layer, Route route, const Effort& effort, Budget& budget) {
    assert(layer.problem.plan == &plan_);
    ChooseEntries(layer, route, budget);
    if (budget.was_exhausted()) return Finish(std::move(route), 0, budget);
    const LeafEntries entries(layer.problem, &budget);
    if (!derived_) derived_.emplace(layer.tree, entries, budget);
    const OrderTree& tree = derived_->tree;
    if (!tree.has_choice()) {
      const double cost = RouteCost(layer.problem, route);
      if (budget.was_exhausted()) return Finish(std::move(route), 0, budget);
      // The order is fixed, and a route of up to one window has the best entries.
      if (route.size() <= static_cast<size_t>(kEntryWindow))
        return Solution{std::move(route), StopReason::kOptimal, cost};
      return Finish(std::move(route), 0, budget);
    }
    FindNeighborsOnce(*derived_, budget);
    if (budget.was_exhausted()) return Finish(std::move(route), 0, budget);
    SearchState state(layer.problem, tree, entries);
    state.Load(route, &budget);
    const int64_t iterations = Improve(layer, effort, state, budget);
    Route improved = state.Unload();
    ChooseEntries(layer, improved, budget);
    const bool optimal =
        !budget.was_exhausted() &&
        SolveSmallParts(layer, SmallParts(layer.problem, effort.small_parts), improved, budget);
    Solution solution = Finish(std::move(improved), iterations, budget);
    if (optimal) {
      solution.stop = StopReason::kOptimal;
      solution.lower_bound = RouteCost(layer.problem, solution.route);
    }
    return solution;
  }

  // Searches on from the route of `state`; returns the iterations.
  int64_t Improve(const LayerView& layer, const Effort& effort, SearchState& state,
                  Budget& budget) const {
    const int paths = state.tree().path_count();
    const IteratedSearchOptions options = WalkOptions(layer, effort, paths, budget);
    IteratedSearch search(state, *derived_->neighbors, options);
    search.Descend(budget);
    Rng rng(layer.problem.seed);
    search.Run(rng, budget);
    if (!IsLong(effort)) return search.iterations();
    const int kicked = Kicked(options);
    LongSearchOptions walks{options, Patience(effort.kicks, kicked), kLeastGain};
    walks.walk.patience = static_cast<int64_t>(kLeastPatience + kWalkPatience * kicked);
    return search.iterations() +
           SearchLong(layer.problem, state, *derived_->neighbors, walks, rng, budget);
  }

  // Of the only walk, or of the first one of a long search.
  IteratedSearchOptions WalkOptions(const LayerView& layer, const Effort& effort, int paths,
                                    Budget& budget) const {
    IteratedSearchOptions options;
    options.local_search = settings_.local_search;
    options.descent_depth = 1;  // kicks find sooner what trials would
    options.first_kicked = effort.first_kicked;
    options.last_kicked = std::min(effort.last_kicked, paths);
    options.patience = Patience(IsLong(effort) ? kFirstWalkEffort : effort.kicks, Kicked(options));
    options.least_gain = kLeastGain;
    options.least_gain_each = options_.least_gain_each;
    options.window = static_cast<double>(options_.gain_window);
    if (options_.least_gain_each == 0) {
      options.long_share = kLongShare;
      options.bridges = kBridges;
      options.least_gain_each = WorthOfIteration(layer.problem, options_.idle_speed_mm_s);
      options.window = effort.detours ? kWorthWindow : kWorthWindowOfMending;
    } else {
      options.earned = effort.kicks > 0 ? kEarned * options_.effort / effort.kicks : kEarned;
      const Route given = GivenRoute(*layer.problem.plan, &budget);
      options.price = [&layer](const Route& of) { return CrossingPrice(layer.problem, of); };
      options.given_cost =
          RouteCost(layer.problem, given, &budget) - CrossingPrice(layer.problem, given);
    }
    options.walls = layer.problem.walls;
    options.most_span = std::clamp(kWidestKicks / paths, kLeastMostSpan, kMostSpan);
    if (!effort.detours) options.temperature = 0;
    return options;
  }

  bool IsLong(const Effort& effort) const {
    return effort.kicks > kLongEffort && options_.least_gain_each == 0;
  }

  static int Kicked(const IteratedSearchOptions& options) {
    return options.last_kicked - options.first_kicked + 1;
  }

  // Iterations without a gain that end a search of such effort, which kicks so many of the paths.
  int64_t Patience(double effort, int kicked) const {
    return static_cast<int64_t>(std::min(effort, 1.0) * kLeastPatience +
                                effort * settings_.patience * kicked);
  }

  static SmallPartOptions SmallParts(const LayerProblem& problem, double effort) {
    SmallPartOptions options;
    const bool walls = problem.walls != nullptr;
    options.most_operations =
        (walls ? kSmallPartOperationsAmongWalls : kSmallPartOperations) * std::min(effort, 4.0);
    return options;
  }

  // Says of the solution, which was found with regard to the next layer, what is proven of it
  // alone.
  void ProveIfSmall(const LayerProblem& problem, Solution& solution, Budget& budget) const {
    if (solution.stop == StopReason::kOptimal) solution.stop = StopReason::kLocalOptimum;
    solution.lower_bound.reset();
    const LayerView layer(problem, &budget);
    const SmallPartOptions options = SmallParts(problem, options_.effort * kResumeShare);
    Route optimal = solution.route;
    if (!IsSmall(layer, options, &budget) || !SolveSmallParts(layer, options, optimal, budget))
      return;
    solution.lower_bound = RouteCost(problem, optimal);
    if (optimal == solution.route) solution.stop = StopReason::kOptimal;
  }

  // Lists that the budget cut short are looked for again.
  void FindNeighborsOnce(DerivedOfPlan& derived, Budget& budget) const {
    if (derived.complete) return;
    const int breadth = settings_.local_search.three_opt.first_breadth;
    derived.neighbors.emplace(FindNeighbors(derived.tree, derived.groups, breadth, budget));
    derived.complete = !budget.was_exhausted();
  }

  static Solution Finish(Route route, int64_t iterations, const Budget& budget) {
    const auto count = static_cast<double>(iterations);
    return Solution{std::move(route),
                    StopOr(budget, StopReason::kLocalOptimum),
                    std::nullopt,
                    {{"iterations", count}},
                    count * kIterationSeconds};
  }

  const AutoOptions options_;
  [[maybe_unused]] const Plan& plan_;  // for assertions
  const AutoSettings settings_;
  std::optional<DerivedOfPlan> derived_;  // by the first search that gets so far
};

class Auto : public PreparingStrategy {
 public:
  Auto(const AutoOptions& options, bool bound, bool bounds_chain)
      : PreparingStrategy(
            {.reuses_routes = true,
             .bound_effort = bound ? options.effort : 0,
             .bound_of_search = options.idle_speed_mm_s > 0
                                    ? kWorthBoundShare
                                    : std::numeric_limits<double>::infinity(),
             .chain_bounding = QuickChainBounding(bounds_chain),
             .look_ahead_paths =
                 options.least_gain_each > 0 ? kLookAheadPathsInHaste : kLookAheadPaths,
             .look_further_paths = options.least_gain_each > 0 ? 0 : kLookFurtherPaths}),
        options_(options) {}

  std::unique_ptr<PreparedLayer> Prepare(const Plan& plan) const override {
    return std::make_unique<AutoLayer>(options_, plan);
  }

 private:
  const AutoOptions options_;
};

}  // namespace

StrategyEntry AutoEntry() {
  return StrategyEntry{
      "auto",
      "The best route for the given time: greedy, improved until it gains nothing more.",
      true,
      {OptionSpec{"effort",
                  OptionSpec::Type::kDouble,
                  "1",
                  0,
                  1e6,
                  {},
                  "How long to continue without a gain, as a multiple of the default."},
       OptionSpec{"least_gain_each",
                  OptionSpec::Type::kDouble,
                  "0",
                  0,
                  1e6,
                  {},
                  "Mean gain in mm or s per iteration below which the search ends. An iteration "
                  "takes about 20 microseconds; testing walls counts as more of them."},
       OptionSpec{
           "gain_window",
           OptionSpec::Type::kInt,
           "200",
           1,
           1e9,
           {},
           "Iterations over which least_gain_each is measured; the search always does that many."},
       OptionSpec{"idle_speed",
                  OptionSpec::Type::kDouble,
                  "0",
                  0,
                  1e6,
                  {},
                  "Speed of travel in mm/s. The search ends when a second of it saves less than "
                  "about a second of travel, by counts of iterations. 0: whatever it still gains. "
                  "Unset: the job's idle_speed_mm_s, unless the job names an effort."},
       BoundOption(true), ChainBoundOption()},
      [](const StrategyOptions& options) -> std::unique_ptr<Strategy> {
        return std::make_unique<Auto>(
            AutoOptions{options.Double("effort"), options.Double("least_gain_each"),
                        options.Int("gain_window"), options.Double("idle_speed")},
            options.Bool("bound"), options.Bool("chain_bound"));
      }};
}

}  // namespace traverse
