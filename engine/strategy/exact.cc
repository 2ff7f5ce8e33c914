#include "engine/strategy/exact.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "engine/cost/route_cost.h"
#include "engine/proof/bounds/lower_bound.h"
#include "engine/proof/walks/stage_model.h"
#include "engine/proof/walks/stage_proof.h"
#include "engine/strategy/auto.h"
#include "engine/strategy/greedy.h"
#include "engine/strategy/ni2opt.h"
#include "engine/strategy/options/framework_options.h"
#include "engine/strategy/stop.h"
#include "engine/weller/interleaved_search.h"
#include "engine/weller/milp/milp_method.h"
#include "engine/weller/steps/island_layout.h"

namespace traverse {
namespace {

// Numbers in a model's matrices: 16 bytes each.
constexpr size_t kMostModelEntries = size_t{16} << 20;

// The better the first route, the more is left out of the search for a proof: it is worth a while.
constexpr char kEffort[] = "20";

std::unique_ptr<Strategy> MakeWith(const StrategyEntry& entry,
                                   const std::map<std::string, std::string>& options) {
  return entry.make(*StrategyOptions::Parse(entry.options, options));
}

std::unique_ptr<Strategy> MakeDefault(const StrategyEntry& entry) { return MakeWith(entry, {}); }

// Shares of the remaining time that the first route may use, and then the first bound. A proof
// needs the rest; but without one, route and bound are the result.
constexpr double kRouteShare = 0.4;
constexpr double kRouteShareWithoutProof = 0.7;
constexpr double kBoundShare = 0.5;
constexpr double kBoundShareWithoutProof = 0.8;

class Exact : public Strategy {
 public:
  // A proof holds for one start only, not for a predicted one.
  Exact(double time_limit_seconds, bool bounds_chain)
      : Strategy({.serial = true,
                  .chain_bounding = bounds_chain ? StrategyTraits::ChainBounding::kByResume
                                                 : StrategyTraits::ChainBounding::kNone}),
        time_limit_seconds_(time_limit_seconds),
        heuristic_(MakeDefault(AutoEntry())),
        long_heuristic_(MakeWith(AutoEntry(), {{"effort", kEffort}})) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    return Prove(problem, FirstRoute(problem, nullptr, budget), budget);
  }

  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    return Prove(problem, FirstRoute(problem, &start, budget), budget);
  }

 private:
  // From `start`, unless that is null.
  Solution FirstRoute(const LayerProblem& problem, const Route* start, Budget& budget) const {
    const bool provable = StageModel::Fits(*problem.plan, kMostModelEntries, &budget);
    Budget share = budget.WithShare(provable ? kRouteShare : kRouteShareWithoutProof);
    const Strategy& heuristic = provable ? *long_heuristic_ : *heuristic_;
    Solution solution = start == nullptr ? heuristic.Solve(problem, share)
                                         : heuristic.Resume(problem, *start, share);
    solution.statistics["provable"] = provable ? 1 : 0;
    return solution;
  }

  Solution Prove(const LayerProblem& problem, Solution solution, Budget& budget) const {
    const double cost = RouteCost(problem, solution.route, &budget);
    if (solution.route.empty()) {
      return Solution{std::move(solution.route), StopReason::kOptimal, cost};
    }
    if (solution.stop == StopReason::kOptimal) return solution;
    Budget limited = budget.Within(std::chrono::duration_cast<Budget::Clock::duration>(
        std::chrono::duration<double>(time_limit_seconds_)));
    const bool provable = solution.statistics["provable"] > 0;
    Budget share = limited.WithShare(provable ? kBoundShare : kBoundShareWithoutProof);
    solution.lower_bound = LowerBound(problem, cost, nullptr, /*effort=*/0, share);
    if (solution.lower_bound == cost) {
      solution.stop = StopReason::kOptimal;
    } else if (!provable || limited.ExhaustedNow() || !ProveByStages(problem, solution, limited)) {
      solution.stop = StopOr(budget, StopOr(limited, solution.stop));
    }
    return solution;
  }

  // False if a limit ended it.
  static bool ProveByStages(const LayerProblem& problem, Solution& solution, Budget& budget) {
    const std::optional<StageModel> model = StageModel::Build(problem, kMostModelEntries, &budget);
    if (!model) return false;
    const StageProof proof =
        traverse::ProveByStages(*model, model->WalkOf(solution.route), StageProofOptions(), budget);
    Route route = model->RouteOf(proof.walk);
    if (RouteCost(problem, route) <= RouteCost(problem, solution.route)) {
      solution.route = std::move(route);
    }
    solution.lower_bound = std::max(solution.lower_bound.value_or(0), proof.lower_bound);
    if (proof.proven) solution.stop = StopReason::kOptimal;
    solution.statistics["passes"] = proof.passes;
    solution.statistics["nodes"] = proof.nodes;
    solution.statistics["cuts"] = proof.cuts;
    return proof.proven;
  }

  const double time_limit_seconds_;
  const std::unique_ptr<Strategy> heuristic_;       // of the first route
  const std::unique_ptr<Strategy> long_heuristic_;  // of one that is to be proven
};

// The thesis's framework with its mixed integer programmes.
class ExactFramework : public Strategy {
 public:
  // `cold`: as the thesis has it, from no start and without greedy's route instead of a longer one.
  ExactFramework(const FrameworkOptions& options, const MilpOptions& milp,
                 double time_limit_seconds, bool cold, bool bound, bool bounds_chain)
      // As the thesis has it, every layer starts where the one before ended.
      : Strategy({.serial = true,
                  .pure = cold,
                  .bound_effort = bound ? 1.0 : 0.0,
                  .chain_bounding = QuickChainBounding(bounds_chain)}),
        options_(options),
        milp_(milp),
        time_limit_seconds_(time_limit_seconds),
        cold_(cold),
        greedy_(MakeDefault(GreedyEntry())),
        heuristic_(MakeDefault(Ni2optEntry())) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    return SolveFrom(problem, nullptr, budget);
  }

  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    return cold_ ? Strategy::Resume(problem, start, budget) : SolveFrom(problem, &start, budget);
  }

 private:
  // No worse than `start`, unless that is null.
  Solution SolveFrom(const LayerProblem& problem, const Route* start, Budget& budget) const {
    const auto first = [&](const Strategy& strategy) {
      return start == nullptr ? strategy.Solve(problem, budget)
                              : strategy.Resume(problem, *start, budget);
    };
    const std::optional<ClassicalLayer> classical = AsClassicalLayer(*problem.plan);
    const std::optional<InterleavedLayer> interleaved = AsInterleavedLayer(*problem.plan);
    if (!classical && !interleaved) {
      Solution solution = first(*heuristic_);
      solution.statistics["framework"] = 0;  // this is ni2opt's route
      return solution;
    }
    Solution solution;
    if (cold_) solution.route = GivenRoute(*problem.plan);
    if (!cold_) solution = first(*greedy_);
    if (budget.ExhaustedNow()) return Stopped(std::move(solution), false, budget);
    MilpMethod method(milp_, time_limit_seconds_, First());
    FrameworkResult found =
        classical ? SearchFramework(problem, *classical, solution.route, options_, method, budget)
                  : SearchInterleaved(problem, *interleaved, options_, method, budget);
    const double cost = RouteCost(problem, found.route);
    DescribeFramework(found, options_, solution.statistics);
    if (cold_ || cost < RouteCost(problem, solution.route)) {
      solution.route = std::move(found.route);
    }
    solution.statistics["framework"] = 1;
    solution.statistics["framework_cost"] = cost;
    Describe("contours", method.contours(), solution.statistics);
    Describe("rasters", method.rasters(), solution.statistics);
    budget.ExhaustedNow();
    return Stopped(std::move(solution), method.timed_out(), budget);
  }

  MilpMethod::FirstRoute First() const {
    if (cold_) return nullptr;
    return [this](const LayerProblem& problem, Budget& budget) {
      return heuristic_->Solve(problem, budget).route;
    };
  }

  static Solution Stopped(Solution solution, bool timed_out, const Budget& budget) {
    solution.stop = StopOr(budget, timed_out ? StopReason::kTimeLimit : StopReason::kLocalOptimum);
    return solution;
  }

  // Sums over the programmes of a step: one, or one per island. Start and end values count only for
  // those that found a route.
  static void Describe(const std::string& step, const std::vector<MilpRoute>& programmes,
                       std::map<std::string, double>& statistics) {
    if (programmes.empty()) return;
    const auto add = [&](const char* name, double value) { statistics[step + name] += value; };
    bool bounded = true;
    for (const MilpRoute& programme : programmes) {
      add("_programmes", 1);
      add("_found", programme.route.empty() ? 0 : 1);
      add("_complete", programme.complete ? 1 : 0);
      add("_columns", programme.columns);
      add("_rows", programme.rows);
      add("_nodes", programme.nodes);
      add("_seconds", programme.seconds);
      bounded = bounded && programme.bound;
      if (programme.route.empty()) continue;
      add("_value", programme.value);
      if (!programme.start) continue;
      add("_start", *programme.start);
      add("_gained", *programme.start - programme.value);
    }
    for (const MilpRoute& programme : programmes) {
      if (bounded) add("_bound", *programme.bound);
    }
    if (programmes.size() == 1) DescribeIncumbents(step, programmes.front(), statistics);
  }

  // When the programme came to what: thesis figures 5.15 to 5.17.
  static void DescribeIncumbents(const std::string& step, const MilpRoute& programme,
                                 std::map<std::string, double>& statistics) {
    constexpr size_t kMost = 30;
    const size_t count = programme.incumbents.size();
    for (size_t i = count > kMost ? count - kMost : 0; i < count; ++i) {
      const std::string name = absl::StrFormat("%s_incumbent_%02d", step, i + 1);
      statistics[name + "_seconds"] = programme.incumbents[i].seconds;
      statistics[name + "_value"] = programme.incumbents[i].value;
    }
  }

  const FrameworkOptions options_;
  const MilpOptions milp_;
  const double time_limit_seconds_;
  const bool cold_;
  const std::unique_ptr<Strategy> greedy_;     // which no result is worse than, unless cold
  const std::unique_ptr<Strategy> heuristic_;  // for plans that the framework does not know
};

std::vector<OptionSpec> Options() {
  using Type = OptionSpec::Type;
  std::vector<OptionSpec> specs = {
      OptionSpec{
          "model",
          Type::kChoice,
          "integrated",
          0,
          0,
          {"integrated", "framework"},
          "integrated: the whole layer at once, proven. framework: the thesis's four steps with "
          "its mixed integer programmes (ni2opt if a plan has no islands; statistic framework 0)."},
      OptionSpec{"time_limit",
                 Type::kDouble,
                 "7200",
                 0,
                 1e6,
                 {},
                 "Longest time in s for one layer, or for each programme of the framework."},
      OptionSpec{"gap",
                 Type::kDouble,
                 "0.15",
                 0,
                 1,
                 {},
                 "Framework: relative gap at which a programme counts as solved."},
      OptionSpec{"strengthened",
                 Type::kBool,
                 "false",
                 0,
                 0,
                 {},
                 "Framework: add one redundant row for each position of a contour."},
      OptionSpec{"start",
                 Type::kChoice,
                 "ni2opt",
                 0,
                 0,
                 {"ni2opt", "none"},
                 "Framework: the route from which each programme starts. none: cold, as in the "
                 "thesis, and never a shorter route of another method."},
      BoundOption(true),
      ChainBoundOption()};
  const std::vector<OptionSpec> shared = FrameworkOptionSpecs("Framework: ");
  specs.insert(specs.end(), shared.begin(), shared.end());
  return specs;
}

std::unique_ptr<Strategy> MakeExact(const StrategyOptions& values) {
  const double time_limit = values.Double("time_limit");
  if (values.Choice("model") == "integrated") {
    return std::make_unique<Exact>(time_limit, values.Bool("chain_bound"));
  }
  FrameworkOptions options = FrameworkOptionsFrom(values);
  const bool cold = values.Choice("start") == "none";
  if (cold) options.visible_in = VisibleIn::kBothPolygons;
  return std::make_unique<ExactFramework>(
      options, MilpOptions{values.Double("gap"), values.Bool("strengthened")}, time_limit, cold,
      values.Bool("bound"), values.Bool("chain_bound"));
}

}  // namespace

StrategyEntry ExactEntry() {
  return StrategyEntry{
      "exact", "A proven optimal route; at the time limit the best one found and a lower bound.",
      true, Options(), MakeExact};
}

}  // namespace traverse
