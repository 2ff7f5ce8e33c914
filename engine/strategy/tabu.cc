#include "engine/strategy/tabu.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/base/rng.h"
#include "engine/construct/greedy.h"
#include "engine/cost/layer_view.h"
#include "engine/cost/route_cost.h"
#include "engine/exact/small_parts.h"
#include "engine/framework/island_layout.h"
#include "engine/strategy/framework_search.h"
#include "engine/strategy/ni2opt.h"
#include "engine/strategy/polisher.h"
#include "engine/strategy/stop.h"

namespace traverse {
namespace {

// Of the time that is left once there is a first route, what the framework may use if it is to be
// polished.
constexpr double kFrameworkShare = 0.3;

// Numbers of polishing's random stream: the framework's are those of its steps.
constexpr uint64_t kPolishStream = 5;

// Layers of up to so many paths are polished as long as it helps; larger ones would take seconds.
constexpr double kFewPaths = 100;

std::unique_ptr<const Strategy> DefaultNi2opt() {
  const StrategyEntry entry = Ni2optEntry();
  return entry.make(*StrategyOptions::Parse(entry.options, {}));
}

struct Candidate {
  Route route;
  double cost = 0;
};

class Tabu : public Strategy {
 public:
  Tabu(const FrameworkOptions& options, bool polish, double polish_rounds, bool bound)
      : options_(options),
        polish_(polish),
        polish_rounds_(polish_rounds),
        bound_(bound),
        ni2opt_(DefaultNi2opt()) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const LayerView layer(problem);
    return polish_ ? SolvePolished(layer, budget) : SolvePlain(layer, budget);
  }

  // The order that was found for another start is a good one still, and tabu search would not find
  // it again any sooner.
  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    if (!polish_) return Strategy::Resume(problem, start, budget);
    const LayerView layer(problem);
    Candidate best = Baseline(layer, budget);
    Polisher polisher(layer, budget);
    Rng rng(StreamSeed(problem.seed, kPolishStream));
    Take(layer, start, best);
    Take(layer, polisher.Iterate(start, Patience(layer), rng, budget), best);
    budget.ExhaustedNow();
    Solution solution{std::move(best.route), StopOr(budget, StopReason::kIterationLimit),
                      std::nullopt};
    FinishSmallParts(layer, solution, budget);
    return solution;
  }

  // As the thesis has it, every layer starts where the one before ended: without polish nothing
  // repairs a route that was found for another start.
  bool serial() const override { return !polish_; }

  bool wants_bound() const override { return bound_; }

 private:
  static void Take(const LayerView& layer, Route route, Candidate& best) {
    const double cost = RouteCost(layer.problem, route);
    if (cost < best.cost) best = {std::move(route), cost};
  }

  // What is small enough for it is solved to optimality.
  static void FinishSmallParts(const LayerView& layer, Solution& solution, Budget& budget) {
    if (!SolveSmallParts(layer, SmallPartOptions(), solution.route, budget)) return;
    solution.stop = StopReason::kOptimal;
    solution.lower_bound = RouteCost(layer.problem, solution.route);
  }

  // What there is at once, and no result is worse than.
  static Candidate Baseline(const LayerView& layer, Budget& budget) {
    Route route = BaselineRoute(layer, budget);
    const double cost = RouteCost(layer.problem, route);
    return {std::move(route), cost};
  }

  Solution SolvePlain(const LayerView& layer, Budget& budget) const {
    Candidate best = Baseline(layer, budget);
    Solution solution;
    Take(layer, Search(layer, best.route, budget, solution.statistics), best);
    budget.ExhaustedNow();
    solution.stop = StopOr(budget, StopReason::kIterationLimit);
    solution.route = std::move(best.route);
    return solution;
  }

  // First what takes little time, so that there is a good route if time is short: greedy's,
  // polished, and that of ni2opt. Then tabu search, and what it found is polished at length.
  Solution SolvePolished(const LayerView& layer, Budget& budget) const {
    Candidate best = Baseline(layer, budget);
    const Route start = best.route;
    Polisher polisher(layer, budget);
    Take(layer, polisher.Descend(best.route, budget), best);
    Take(layer, ni2opt_->Solve(layer.problem, budget).route, best);

    Solution solution;
    Budget share = FrameworkBudget(budget);
    Route found = Search(layer, start, share, solution.statistics);
    Rng rng(StreamSeed(layer.problem.seed, kPolishStream));
    Take(layer, polisher.Iterate(best.route, Patience(layer), rng, budget), best);
    Take(layer, polisher.Iterate(std::move(found), Patience(layer), rng, budget), best);
    budget.ExhaustedNow();
    solution.stop = StopOr(budget, StopOr(share, StopReason::kIterationLimit));
    solution.route = std::move(best.route);
    FinishSmallParts(layer, solution, budget);
    return solution;
  }

  // Kicks without gain: of each path, beyond kFewPaths of each tenth one.
  int64_t Patience(const LayerView& layer) const {
    const double paths = static_cast<double>(layer.plan().paths.size());
    return static_cast<int64_t>(
        polish_rounds_ * (paths < kFewPaths ? paths : kFewPaths + 0.1 * (paths - kFewPaths)));
  }

  Budget FrameworkBudget(const Budget& budget) const {
    if (!budget.deadline()) return budget;
    const auto left = *budget.deadline() - Budget::Clock::now();
    return budget.Within(
        std::chrono::duration_cast<Budget::Clock::duration>(left * kFrameworkShare));
  }

  Route Search(const LayerView& layer, const Route& start, Budget& budget,
               std::map<std::string, double>& statistics) const {
    const std::optional<ClassicalLayer> classical = AsClassicalLayer(layer.plan());
    if (!classical) return SearchAnyPlan(layer.problem, start, options_, budget);
    FrameworkResult result = SearchFramework(layer.problem, *classical, start, options_, budget);
    statistics["framework_cost"] = RouteCost(layer.problem, result.route);
    statistics["diversifications"] = result.diversifications;
    statistics["evaluations"] = static_cast<double>(result.evaluations);
    statistics["points_entries"] = result.points.entries;
    statistics["points_island_analysis"] = result.points.island_analysis;
    statistics["points_sp"] = result.points.spaced;
    statistics["points_bbcp"] = result.points.box_center;
    statistics["points_vp"] = result.points.visible;
    if (options_.representation == Representation::kNearRasterPoints) {
      statistics["points_nrp"] = result.points.near_raster;
    }
    return std::move(result.route);
  }

  FrameworkOptions options_;
  bool polish_;
  double polish_rounds_;
  bool bound_;
  std::unique_ptr<const Strategy> ni2opt_;
};

OptionSpec Number(const char* name, OptionSpec::Type type, const char* default_value,
                  double minimum, double maximum, const char* description) {
  return OptionSpec{name, type, default_value, minimum, maximum, {}, description};
}

OptionSpec Switch(const char* name, const char* default_value, const char* description) {
  return OptionSpec{name, OptionSpec::Type::kBool, default_value, 0, 0, {}, description};
}

std::vector<OptionSpec> Options() {
  using Type = OptionSpec::Type;
  return {
      OptionSpec{
          "representation",
          Type::kChoice,
          "bbcp",
          0,
          0,
          {"sp", "nrp", "bbcp"},
          "What stands for a contour in the preliminary sequence: spaced points, points near "
          "the ends of the island's rasters, or the center of its bounding box."},
      Number("spacing_mm", Type::kDouble, "2.5", 0, 1000,
             "Least distance of the spaced points of a contour (Dp), in mm."),
      Number("neighbors", Type::kInt, "2", 1, 100,
             "Contours that the growing circle around one has to meet."),
      Number("first_radius_mm", Type::kDouble, "0", 0, 1000,
             "Radius of the circle at first, in mm; 0: the shorter side of the bounding box."),
      Number("radius_step_mm", Type::kDouble, "5", 0.001, 1000,
             "How much the circle grows at a time, in mm."),
      Number("neighbor_penalty", Type::kDouble, "100", 0, 1e6,
             "A link outside the neighborhoods counts as if it were so much longer, in mm."),
      Number("order_penalty", Type::kDouble, "1000", 0, 1e6,
             "The same for an order that the plan rules out, in mm; no result has one."),
      Number("diversifications", Type::kInt, "2500", 1, 1000000,
             "How often the search starts anew, in each of the steps for contours and rasters."),
      OptionSpec{"diversification",
                 Type::kChoice,
                 "random",
                 0,
                 0,
                 {"random", "swaps"},
                 "From what: a random sequence, or the best one after random swaps."},
      Number("swaps", Type::kDouble, "0.3", 0, 10,
             "How many random swaps for each contour or raster, three at least."),
      Number("list_size", Type::kDouble, "1.5", 0, 100,
             "Moves in the tabu list for each contour or raster."),
      Number("tenure", Type::kDouble, "0.1", 0, 100,
             "Iterations that a move is tabu, for each diversification."),
      Number("patience", Type::kInt, "3", 0, 10000,
             "Moves without gain after which the search starts anew."),
      Number("evaluations", Type::kInt, "20000000", 0, 1e12,
             "Swaps evaluated that end the search of each step, whatever number of "
             "diversifications is left; 0: no limit."),
      Switch("reactive", "false",
             "Sequences that come again make the tenure longer, or start the search anew."),
      Number("elite", Type::kInt, "5", 1, 100,
             "Preliminary sequences that the next step makes feasible and relinks."),
      Number("relinked", Type::kInt, "5", 0, 100,
             "Sequences on the way from each of these to the best one that it tries as well."),
      Switch("polish", "true",
             "Improve the route over all vertices of the contours, by iterated local search."),
      Number("polish_rounds", Type::kDouble, "1", 0, 1000000,
             "Kicks in a row without gain that end the polishing, for each path; beyond 100 "
             "paths, for each ten."),
      BoundOption(false)};
}

std::unique_ptr<Strategy> MakeTabu(const StrategyOptions& values) {
  FrameworkOptions options;
  options.representation = RepresentationNamed(values.Choice("representation"));
  options.spacing_mm = values.Double("spacing_mm");
  options.neighborhood.neighbors = static_cast<int>(values.Int("neighbors"));
  options.neighborhood.first_radius_mm = values.Double("first_radius_mm");
  options.neighborhood.step_mm = values.Double("radius_step_mm");
  options.neighbor_penalty_mm = values.Double("neighbor_penalty");
  options.relinked = static_cast<int>(values.Int("relinked"));
  TabuOptions& tabu = options.tabu;
  tabu.order_penalty_mm = values.Double("order_penalty");
  tabu.diversifications = static_cast<int>(values.Int("diversifications"));
  tabu.diversification = values.Choice("diversification") == "swaps"
                             ? TabuOptions::Diversification::kSwaps
                             : TabuOptions::Diversification::kRandom;
  tabu.swaps = values.Double("swaps");
  tabu.list_size = values.Double("list_size");
  tabu.tenure = values.Double("tenure");
  tabu.patience = static_cast<int>(values.Int("patience"));
  tabu.evaluations = values.Int("evaluations");
  tabu.reactive = values.Bool("reactive");
  tabu.elite = static_cast<int>(values.Int("elite"));
  return std::make_unique<Tabu>(options, values.Bool("polish"), values.Double("polish_rounds"),
                                values.Bool("bound"));
}

}  // namespace

StrategyEntry TabuEntry() {
  return StrategyEntry{
      "tabu",
      "The framework of four steps with tabu search, polished; never behind ni2opt "
      "unless polish is off.",
      true, Options(), MakeTabu};
}

}  // namespace traverse
