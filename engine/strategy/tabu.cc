#include "engine/strategy/tabu.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/base/rng.h"
#include "engine/cost/layer_view.h"
#include "engine/cost/route_cost.h"
#include "engine/proof/small_parts/small_parts.h"
#include "engine/search/greedy/greedy.h"
#include "engine/search/polisher.h"
#include "engine/strategy/ni2opt.h"
#include "engine/strategy/options/framework_options.h"
#include "engine/strategy/stop.h"
#include "engine/weller/framework_search.h"
#include "engine/weller/interleaved_search.h"
#include "engine/weller/steps/island_layout.h"

namespace traverse {
namespace {

// Share of the time left after the first route that the framework may use if its result is
// polished.
constexpr double kFrameworkShare = 0.3;

// Numbers of polishing's random stream: the framework's are those of its steps.
constexpr uint64_t kPolishStream = 5;

// Layers of up to this many paths are polished as long as it helps; larger ones would take seconds.
constexpr double kFewPaths = 100;

std::unique_ptr<const Strategy> DefaultNi2opt() {
  const StrategyEntry entry = Ni2optEntry();
  return entry.make(*StrategyOptions::Parse(entry.options, {}));
}

struct Candidate {
  Route route;
  double cost = 0;
};

// The framework on `layer`, or tabu search over its whole plan where that knows of no islands.
Route Search(const LayerView& layer, const Route& start, const FrameworkOptions& options,
             Budget& budget, std::map<std::string, double>& statistics) {
  const std::optional<ClassicalLayer> classical = AsClassicalLayer(layer.plan());
  const std::optional<InterleavedLayer> interleaved = AsInterleavedLayer(layer.plan());
  if (!classical && !interleaved) return SearchAnyPlan(layer.problem, start, options, budget);
  FrameworkResult result = classical
                               ? SearchFramework(layer.problem, *classical, start, options, budget)
                               : SearchInterleaved(layer.problem, *interleaved, options, budget);
  statistics["framework_cost"] = RouteCost(layer.problem, result.route);
  statistics["diversifications"] = result.diversifications;
  statistics["evaluations"] = static_cast<double>(result.evaluations);
  DescribeFramework(result, options, statistics);
  return std::move(result.route);
}

// Metaheuristic of the thesis, step by step as it is written.
class ThesisTabu : public Strategy {
 public:
  explicit ThesisTabu(const FrameworkOptions& options)
      : Strategy({.serial = true, .pure = true}), options_(options) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const LayerView layer(problem, &budget);
    Solution solution;
    solution.route = Search(layer, GivenRoute(layer.plan()), options_, budget, solution.statistics);
    budget.ExhaustedNow();
    solution.stop = StopOr(budget, StopReason::kIterationLimit);
    return solution;
  }

 private:
  const FrameworkOptions options_;
};

class Tabu : public Strategy {
 public:
  Tabu(const FrameworkOptions& options, bool polish, double polish_rounds, bool bound)
      : Strategy(Traits(polish, bound)),
        options_(options),
        polish_(polish),
        polish_rounds_(polish_rounds),
        ni2opt_(DefaultNi2opt()) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const LayerView layer(problem, &budget);
    return polish_ ? SolvePolished(layer, budget)
                   : SolvePlain(layer, Baseline(layer, budget), budget);
  }

  // The order that was found for another start is a good one still, and tabu search would not find
  // it again any sooner. Without polish it begins there.
  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    const LayerView layer(problem, &budget);
    Candidate best = Baseline(layer, budget);
    Take(layer, start, best);
    if (!polish_) return SolvePlain(layer, std::move(best), budget);
    Polisher polisher(layer, budget);
    Rng rng(StreamSeed(problem.seed, kPolishStream));
    Take(layer, polisher.Iterate(start, Patience(layer), rng, budget), best);
    budget.ExhaustedNow();
    Solution solution{std::move(best.route), StopOr(budget, StopReason::kIterationLimit),
                      std::nullopt};
    FinishSmallParts(layer, solution, budget);
    return solution;
  }

 private:
  // As the thesis has it, every layer starts where the one before ended: without polish nothing
  // repairs a route that was found for another start.
  static StrategyTraits Traits(bool polish, bool bound) {
    return {.serial = !polish, .bound_effort = bound ? 1.0 : 0.0};
  }

  static void Take(const LayerView& layer, Route route, Candidate& best) {
    const double cost = RouteCost(layer.problem, route);
    if (cost < best.cost) best = {std::move(route), cost};
  }

  // Small enough layers are solved to optimality.
  static void FinishSmallParts(const LayerView& layer, Solution& solution, Budget& budget) {
    if (!SolveSmallParts(layer, SmallPartOptions(), solution.route, budget)) return;
    solution.stop = StopReason::kOptimal;
    solution.lower_bound = RouteCost(layer.problem, solution.route);
  }

  // The route that exists at once; no result is worse.
  static Candidate Baseline(const LayerView& layer, Budget& budget) {
    Route route = BaselineRoute(layer, budget);
    const double cost = RouteCost(layer.problem, route);
    return {std::move(route), cost};
  }

  Solution SolvePlain(const LayerView& layer, Candidate best, Budget& budget) const {
    Solution solution;
    Take(layer, Search(layer, best.route, options_, budget, solution.statistics), best);
    return Ended(std::move(best), std::move(solution), budget);
  }

  static Solution Ended(Candidate best, Solution solution, Budget& budget) {
    budget.ExhaustedNow();
    solution.stop = StopOr(budget, StopReason::kIterationLimit);
    solution.route = std::move(best.route);
    return solution;
  }

  // First the quick parts, so that there is a good route if time is short: greedy's, polished, and
  // that of ni2opt. Then tabu search, and a long polish of its result.
  Solution SolvePolished(const LayerView& layer, Budget& budget) const {
    Candidate best = Baseline(layer, budget);
    const Route start = best.route;
    Solution solution;
    // Each of the next steps takes a pass over the layer, and nobody waits for a cancelled job.
    if (budget.cancelled()) return Ended(std::move(best), std::move(solution), budget);
    Polisher polisher(layer, budget);
    Take(layer, polisher.Descend(best.route, budget), best);
    if (budget.cancelled()) return Ended(std::move(best), std::move(solution), budget);
    Take(layer, ni2opt_->Solve(layer.problem, budget).route, best);
    if (budget.cancelled()) return Ended(std::move(best), std::move(solution), budget);
    Budget share = budget.WithShare(kFrameworkShare);
    Route found = Search(layer, start, options_, share, solution.statistics);
    if (budget.cancelled()) return Ended(std::move(best), std::move(solution), budget);
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

  FrameworkOptions options_;
  bool polish_;
  double polish_rounds_;
  std::unique_ptr<const Strategy> ni2opt_;
};

// The thesis as written, which leaves open when an intensification ends: here after as many moves
// without gain as a move is tabu, as its times grow by 3 to 4.5 where the diversifications, of
// which the tenure is a tenth, are twice as many (tables 5.7 and 5.8, step 2).
FrameworkOptions AsWritten(FrameworkOptions options) {
  TabuOptions& tabu = options.tabu;
  tabu.published = true;
  tabu.patience = static_cast<int>(std::max(1.0, tabu.tenure * tabu.diversifications));
  tabu.evaluations = 0;
  tabu.elite = 1;
  options.relinked = 0;
  options.visible_in = VisibleIn::kBothPolygons;
  options.point_relinkings = tabu.diversifications;
  return options;
}

std::vector<OptionSpec> Options() {
  using Type = OptionSpec::Type;
  std::vector<OptionSpec> specs = FrameworkOptionSpecs("");
  const std::vector<OptionSpec> own = {
      NumberOption("neighbor_penalty", Type::kDouble, "100", 0, 1e6,
                   "Added to the length of a move outside the neighborhoods, in mm."),
      NumberOption("order_penalty", Type::kDouble, "1000", 0, 1e6,
                   "The same for an order that the plan forbids, in mm; no result has one."),
      NumberOption("diversifications", Type::kInt, "2500", 1, 1000000,
                   "How often the search restarts, in each of the steps for contours and rasters."),
      OptionSpec{"diversification",
                 Type::kChoice,
                 "random",
                 0,
                 0,
                 {"random", "swaps"},
                 "Where it restarts: a random sequence, or the best one after random swaps."},
      NumberOption("swaps", Type::kDouble, "0.3", 0, 10,
                   "Random swaps per contour or raster; at least three in all."),
      NumberOption("list_size", Type::kDouble, "1.5", 0, 100,
                   "Moves in the tabu list per contour or raster."),
      NumberOption("tenure", Type::kDouble, "0.1", 0, 100,
                   "Iterations for which a move is tabu, per diversification."),
      NumberOption("patience", Type::kInt, "3", 0, 10000,
                   "Moves without gain after which the search restarts."),
      NumberOption("evaluations", Type::kInt, "20000000", 0, 1e12,
                   "Most swaps that each step evaluates, however many diversifications are left; "
                   "0: no limit."),
      SwitchOption("reactive", "false",
                   "Lengthen the tenure, or restart, when a sequence repeats."),
      NumberOption("elite", Type::kInt, "5", 1, 100,
                   "Preliminary sequences that the next step makes feasible and relinks."),
      NumberOption("relinked", Type::kInt, "5", 0, 100,
                   "Sequences between each of these and the best one that it also tries."),
      SwitchOption(
          "polish", "true",
          "Improve the route over all vertices of the contours, by iterated local search."),
      NumberOption("polish_rounds", Type::kDouble, "2", 0, 1000000,
                   "Kicks in a row without gain that end the polishing, per path; beyond 100 "
                   "paths, per ten."),
      SwitchOption("thesis", "false",
                   "Only the thesis's search as written: random first sequence, the list kept over "
                   "restarts, as many moves without gain as one is tabu, points by path relinking. "
                   "Ignores polish, patience, elite, relinked and evaluations."),
      BoundOption(false)};
  specs.insert(specs.end(), own.begin(), own.end());
  return specs;
}

std::unique_ptr<Strategy> MakeTabu(const StrategyOptions& values) {
  FrameworkOptions options = FrameworkOptionsFrom(values);
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
  if (values.Bool("thesis")) return std::make_unique<ThesisTabu>(AsWritten(options));
  return std::make_unique<Tabu>(options, values.Bool("polish"), values.Double("polish_rounds"),
                                values.Bool("bound"));
}

}  // namespace

StrategyEntry TabuEntry() {
  return StrategyEntry{"tabu",
                       "The thesis's four steps with tabu search, polished; never longer than "
                       "ni2opt unless polish is off.",
                       true, Options(), MakeTabu};
}

}  // namespace traverse
