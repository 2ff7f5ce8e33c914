#include "engine/strategy/exact.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/cost/route_cost.h"
#include "engine/exact/lower_bound.h"
#include "engine/exact/stage_model.h"
#include "engine/exact/stage_proof.h"
#include "engine/framework/island_layout.h"
#include "engine/strategy/auto.h"
#include "engine/strategy/framework_milp.h"
#include "engine/strategy/greedy.h"
#include "engine/strategy/ni2opt.h"
#include "engine/strategy/stop.h"

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

// Of the time left, what the first route may use, and then the first bound: a proof needs the rest,
// but route and bound are what there is when it is not found, or cannot be.
constexpr double kRouteShare = 0.4;
constexpr double kRouteShareWithoutProof = 0.7;
constexpr double kBoundShare = 0.5;
constexpr double kBoundShareWithoutProof = 0.8;

Budget Share(const Budget& budget, double share) {
  if (!budget.deadline()) return budget;
  const auto left = *budget.deadline() - Budget::Clock::now();
  return budget.Within(std::chrono::duration_cast<Budget::Clock::duration>(left * share));
}

class Exact : public Strategy {
 public:
  explicit Exact(double time_limit_seconds)
      : time_limit_seconds_(time_limit_seconds),
        heuristic_(MakeDefault(AutoEntry())),
        long_heuristic_(MakeWith(AutoEntry(), {{"effort", kEffort}})) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    return Prove(problem, FirstRoute(problem, budget), budget);
  }

  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    Solution found = FirstRoute(problem, budget);
    if (RouteCost(problem, start) < RouteCost(problem, found.route)) found.route = start;
    return Prove(problem, std::move(found), budget);
  }

  // A proof holds for one start only: predicted ones would be work for nothing.
  bool serial() const override { return true; }

 private:
  Solution FirstRoute(const LayerProblem& problem, const Budget& budget) const {
    const bool provable = StageModel::Fits(*problem.plan, kMostModelEntries);
    Budget share = Share(budget, provable ? kRouteShare : kRouteShareWithoutProof);
    Solution solution = (provable ? long_heuristic_ : heuristic_)->Solve(problem, share);
    solution.statistics["provable"] = provable ? 1 : 0;
    return solution;
  }

  Solution Prove(const LayerProblem& problem, Solution solution, Budget& budget) const {
    const double cost = RouteCost(problem, solution.route);
    if (solution.route.empty()) {
      return Solution{std::move(solution.route), StopReason::kOptimal, cost};
    }
    if (solution.stop == StopReason::kOptimal) return solution;
    Budget limited = budget.Within(std::chrono::duration_cast<Budget::Clock::duration>(
        std::chrono::duration<double>(time_limit_seconds_)));
    const bool provable = solution.statistics["provable"] > 0;
    Budget share = Share(limited, provable ? kBoundShare : kBoundShareWithoutProof);
    solution.lower_bound = LowerBound(problem, cost, nullptr, share);
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
  ExactFramework(const FrameworkOptions& options, const MilpOptions& milp,
                 double time_limit_seconds, bool bound)
      : options_(options),
        milp_(milp),
        time_limit_seconds_(time_limit_seconds),
        bound_(bound),
        greedy_(MakeDefault(GreedyEntry())),
        heuristic_(MakeDefault(Ni2optEntry())) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const std::optional<ClassicalLayer> layer = AsClassicalLayer(*problem.plan);
    if (!layer) return heuristic_->Solve(problem, budget);
    Solution solution = greedy_->Solve(problem, budget);
    if (budget.ExhaustedNow()) return solution;
    MilpMethod method(milp_, time_limit_seconds_);
    FrameworkResult found =
        SearchFramework(problem, *layer, solution.route, options_, method, budget);
    const double cost = RouteCost(problem, found.route);
    if (cost < RouteCost(problem, solution.route)) solution.route = std::move(found.route);
    solution.statistics["framework_cost"] = cost;
    Describe("contours", method.contours(), solution.statistics);
    Describe("rasters", method.rasters(), solution.statistics);
    budget.ExhaustedNow();
    solution.stop =
        StopOr(budget, method.timed_out() ? StopReason::kTimeLimit : StopReason::kLocalOptimum);
    return solution;
  }

  // As the thesis has it, every layer starts where the one before ended.
  bool serial() const override { return true; }

  bool wants_bound() const override { return bound_; }

 private:
  static void Describe(const std::string& step, const MilpRoute& programme,
                       std::map<std::string, double>& statistics) {
    if (programme.columns == 0) return;
    statistics[step + "_columns"] = programme.columns;
    statistics[step + "_rows"] = programme.rows;
    statistics[step + "_nodes"] = programme.nodes;
    statistics[step + "_value"] = programme.value;
    if (programme.bound) statistics[step + "_bound"] = *programme.bound;
  }

  const FrameworkOptions options_;
  const MilpOptions milp_;
  const double time_limit_seconds_;
  const bool bound_;
  const std::unique_ptr<Strategy> greedy_;     // which no result is worse than
  const std::unique_ptr<Strategy> heuristic_;  // for plans that the framework does not know
};

std::vector<OptionSpec> Options() {
  using Type = OptionSpec::Type;
  return {
      OptionSpec{"model",
                 Type::kChoice,
                 "integrated",
                 0,
                 0,
                 {"integrated", "framework"},
                 "The whole layer at once, proven; or the four steps of the thesis with its mixed "
                 "integer programmes (in sequential deposition; ni2opt else)."},
      OptionSpec{"time_limit",
                 Type::kDouble,
                 "7200",
                 0,
                 1e6,
                 {},
                 "Longest time in s: for one layer, or for each programme of the framework."},
      OptionSpec{"representation",
                 Type::kChoice,
                 "bbcp",
                 0,
                 0,
                 {"sp", "nrp", "bbcp"},
                 "Framework: what stands for a contour in the preliminary sequence."},
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
                 "Framework: one redundant row more for each position of a contour."},
      BoundOption(true)};
}

std::unique_ptr<Strategy> MakeExact(const StrategyOptions& values) {
  const double time_limit = values.Double("time_limit");
  if (values.Choice("model") == "integrated") return std::make_unique<Exact>(time_limit);
  FrameworkOptions options;
  options.representation = RepresentationNamed(values.Choice("representation"));
  return std::make_unique<ExactFramework>(
      options, MilpOptions{values.Double("gap"), values.Bool("strengthened")}, time_limit,
      values.Bool("bound"));
}

}  // namespace

StrategyEntry ExactEntry() {
  return StrategyEntry{
      "exact", "Routes proven optimal; at the time limit the best one found and a lower bound.",
      true, Options(), MakeExact};
}

}  // namespace traverse
