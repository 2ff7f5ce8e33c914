#include "engine/proof/bounds/lower_bound.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/cost/route_cost.h"
#include "engine/proof/bounds/programme_bound.h"
#include "engine/proof/bounds/tree_bound.h"
#include "engine/proof/bounds/vertex_bound.h"

namespace traverse {
namespace {

// Each round searches with the near pairs known so far, and makes more of them known.
constexpr int kRounds = 3;
constexpr int kStepsPerRound = 40;

// Evaluations at the end, as long as they gain so much.
constexpr int kMostEvaluations = 6;
constexpr double kLeastGain = 1e-3;

// Rounds of the search that knows points, where it fits, for an effort of up to 1, and beyond by
// its root; fewer from multipliers that were found before.
constexpr double kVertexRounds = 4;
constexpr double kMostVertexRounds = 40;
constexpr int kVertexRoundsAgain = 2;
constexpr double kShareOfProgrammeAgain = 0.25;

// Of the time that is left, what a search may use: the evaluation after it is what counts.
constexpr double kSearchShare = 0.4;

int VertexRounds(double effort) {
  const double rounds = kVertexRounds * std::sqrt(std::max(1.0, effort));
  return static_cast<int>(std::min(rounds, kMostVertexRounds));
}

Budget SearchBudget(const Budget& budget) {
  if (!budget.deadline()) return budget;
  const auto left = *budget.deadline() - Budget::Clock::now();
  return budget.Within(std::chrono::duration_cast<Budget::Clock::duration>(left * kSearchShare));
}

// Each evaluation makes the true costs of its trees' moves known where boxes stood for contours.
void EvaluateAgain(TreeBound& tree, Budget& budget) {
  for (int times = 0; times < kMostEvaluations; ++times) {
    const double before = tree.lower_bound();
    tree.SetMultipliers(tree.multipliers());
    if (!tree.Evaluate(budget) || tree.lower_bound() < before * (1 + kLeastGain)) return;
  }
}

// The bound of `tree`, made better with `multipliers` of before if they fit, which become those of
// the bound.
std::optional<double> BoundByTrees(const LayerProblem& problem, double target, TreeBound& tree,
                                   BoundMultipliers* multipliers, double effort, Budget& budget) {
  if (budget.ExhaustedNow()) return std::nullopt;
  const bool known = multipliers != nullptr && multipliers->size() == tree.multipliers().size();
  if (known) tree.SetMultipliers(*multipliers);
  if (!tree.Evaluate(budget)) return std::nullopt;
  for (int round = 0; round < kRounds && !known && tree.lower_bound() < target; ++round) {
    Budget search = SearchBudget(budget);
    tree.Ascend(target, kStepsPerRound, search);
    if (!tree.Evaluate(budget)) break;
  }
  EvaluateAgain(tree, budget);
  if (multipliers != nullptr) *multipliers = tree.multipliers();
  double bound = tree.lower_bound();
  if (bound < target && VertexBound::Fits(tree.graph())) {
    VertexBound vertices(problem, tree.graph(), tree.multipliers());
    const int rounds = known ? kVertexRoundsAgain : VertexRounds(effort);
    bound = std::max(bound, vertices.Search(target, rounds, budget));
  }
  if (bound < target && effort > 0) {
    if (known) effort *= kShareOfProgrammeAgain;
    bound = std::max(bound, ProgrammeBound(problem, target, effort, budget).value_or(0));
  }
  return std::min(bound, target);
}

}  // namespace

std::optional<double> LowerBound(const LayerProblem& problem, double target,
                                 BoundMultipliers* multipliers, double effort, Budget& budget) {
  if (problem.plan->paths.empty()) return RouteCost(problem, {});
  if (budget.ExhaustedNow()) return std::nullopt;
  TreeBound tree(problem, budget);
  const std::optional<double> bound =
      BoundByTrees(problem, target, tree, multipliers, effort, budget);
  tree.Clear(budget);
  return bound;
}

}  // namespace traverse
