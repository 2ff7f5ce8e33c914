#include "engine/proof/bounds/lower_bound.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/cost/route_cost.h"
#include "engine/proof/bounds/programme_bound.h"
#include "engine/proof/trees/tree_bound.h"
#include "engine/proof/vertices/vertex_bound.h"

namespace traverse {
namespace {

// Each round searches with the near pairs known so far, and makes more of them known.
constexpr int kRounds = 3;
constexpr int kStepsPerRound = 40;

// Evaluations at the end, as long as they gain so much.
constexpr int kMostEvaluations = 6;
constexpr double kLeastGain = 1e-3;

// Rounds of the search that knows points, where it fits, for an effort of up to 1, and beyond by
// its root. It begins anew for each start: a search takes some 28 KB for each end of a path, and a
// job's layers may wait by the hundred.
constexpr double kVertexRounds = 8;
constexpr double kMostVertexRounds = 40;

// Up to this effort, programmes would take as long as the search, and gain little.
constexpr double kEffortWithoutProgrammes = 1;
constexpr double kShareOfProgrammeAgain = 0.25;

// Work, as for the rounds: about half as much time as a search takes. Where points of few-pointed
// ends are scattered over each other, the first rounds gain nothing, and a search takes long.
constexpr double kVertexWorkOfEnd = 120'000;
constexpr double kVertexWorkOfPoint = 2000;
constexpr double kPointsOfFew = 10;  // on average
constexpr double kMoreWorkWhileFar = 4;

// Of the time that is left, what a search may use: the evaluation after it is what counts.
constexpr double kSearchShare = 0.4;

// What a unit of the work of either search takes, in seconds, and of that time what trees may use.
constexpr double kSecondsOfPair = 100e-9;
constexpr double kSecondsOfVertexWork = 2.5e-9;
constexpr double kShareOfTrees = 0.4;

VertexBound::Limits VertexLimits(double effort, double most_seconds, const EndGraph& graph) {
  const double rounds =
      std::min(kVertexRounds * std::sqrt(std::max(1.0, effort)), kMostVertexRounds);
  const auto ends = static_cast<double>(graph.ends.size());
  double points = 0;
  for (const PathEnd& end : graph.ends) points += static_cast<double>(end.points.size());
  const double work =
      std::max(1.0, effort) * (kVertexWorkOfEnd * ends + kVertexWorkOfPoint * points);
  const double while_far = points > kPointsOfFew * ends ? work : kMoreWorkWhileFar * work;
  const double most = most_seconds / kSecondsOfVertexWork;
  return {static_cast<int>(rounds), std::min(work, most), std::min(while_far, most)};
}

// Each evaluation makes the true costs of its trees' moves known where boxes stood for contours.
void EvaluateAgain(TreeBound& tree, Budget& budget) {
  for (int times = 0; times < kMostEvaluations; ++times) {
    const double before = tree.lower_bound();
    tree.SetMultipliers(tree.multipliers());
    if (!tree.Evaluate(budget) || tree.lower_bound() < before * (1 + kLeastGain)) return;
  }
}

// Steps of each round that take about so long.
int TreeSteps(const TreeBound& tree, double most_seconds) {
  const double each = kSecondsOfPair * static_cast<double>(tree.pairs().size());
  const double steps = most_seconds / (kRounds * each);
  return steps < kStepsPerRound ? static_cast<int>(steps) : kStepsPerRound;
}

// The bound of `tree`, made better; `multipliers` as those of LowerBound.
std::optional<double> BoundByTrees(double target, TreeBound& tree, BoundMultipliers& multipliers,
                                   double most_seconds, Budget& budget) {
  if (budget.ExhaustedNow()) return std::nullopt;
  const bool known = multipliers.size() == tree.multipliers().size();
  if (known) tree.SetMultipliers(multipliers);
  if (!tree.Evaluate(budget)) return std::nullopt;
  for (int round = 0; round < kRounds && !known && tree.lower_bound() < target; ++round) {
    Budget part = budget.WithShare(kSearchShare);
    tree.Ascend(target, TreeSteps(tree, most_seconds), part);
    if (!tree.Evaluate(budget)) break;
  }
  EvaluateAgain(tree, budget);
  multipliers = tree.multipliers();
  return tree.lower_bound();
}

std::optional<double> BoundByMultipliers(const LayerProblem& problem, double target,
                                         BoundMultipliers& multipliers, double effort,
                                         double most_seconds, Budget& budget) {
  TreeBound tree(problem, budget);
  std::optional<double> bound =
      BoundByTrees(target, tree, multipliers, kShareOfTrees * most_seconds, budget);
  if (bound && *bound < target && VertexBound::Fits(tree.graph())) {
    VertexBound points(problem, tree);
    const VertexBound::Limits limits =
        VertexLimits(effort, (1 - kShareOfTrees) * most_seconds, tree.graph());
    bound = std::max(*bound, points.Search(target, limits, budget));
  }
  tree.Clear(budget);
  return bound;
}

}  // namespace

std::optional<double> LowerBound(const LayerProblem& problem, double target,
                                 BoundMultipliers* multipliers, double effort, Budget& budget,
                                 double most_seconds) {
  if (problem.plan->paths.empty()) return RouteCost(problem, {});
  if (budget.ExhaustedNow()) return std::nullopt;
  BoundMultipliers own;
  BoundMultipliers& shared = multipliers != nullptr ? *multipliers : own;
  const bool known = !shared.empty();
  std::optional<double> bound =
      BoundByMultipliers(problem, target, shared, effort, most_seconds, budget);
  if (!bound) return std::nullopt;
  if (*bound < target && effort > kEffortWithoutProgrammes) {
    if (known) effort *= kShareOfProgrammeAgain;
    bound = std::max(*bound, ProgrammeBound(problem, target, effort, budget).value_or(0));
  }
  return std::min(*bound, target);
}

}  // namespace traverse
