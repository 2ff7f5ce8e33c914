#include "engine/proof/bounds/lower_bound.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

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
// its root; fewer from multipliers that were found before, and where a search goes on.
constexpr double kVertexRounds = 8;
constexpr double kMostVertexRounds = 40;
constexpr double kShareOfRoundsAgain = 0.5;
constexpr double kShareOfRoundsOnward = 0.25;
constexpr double kShareOfProgrammeAgain = 0.25;

// Of the time that is left, what a search may use: the evaluation after it is what counts.
constexpr double kSearchShare = 0.4;

double VertexRounds(double effort) {
  return std::min(kVertexRounds * std::sqrt(std::max(1.0, effort)), kMostVertexRounds);
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

// The bound of `tree`, made better; `search` as that of LowerBound.
std::optional<double> BoundByTrees(double target, TreeBound& tree, BoundSearch& search,
                                   Budget& budget) {
  if (budget.ExhaustedNow()) return std::nullopt;
  const bool known = search.multipliers.size() == tree.multipliers().size();
  if (known) tree.SetMultipliers(search.multipliers);
  if (!tree.Evaluate(budget)) return std::nullopt;
  for (int round = 0; round < kRounds && !known && tree.lower_bound() < target; ++round) {
    Budget part = SearchBudget(budget);
    tree.Ascend(target, kStepsPerRound, part);
    if (!tree.Evaluate(budget)) break;
  }
  EvaluateAgain(tree, budget);
  search.multipliers = tree.multipliers();
  return tree.lower_bound();
}

std::optional<double> BoundFromNothing(const LayerProblem& problem, double target,
                                       BoundSearch& search, int rounds, Budget& budget) {
  TreeBound tree(problem, budget);
  std::optional<double> bound = BoundByTrees(target, tree, search, budget);
  if (bound && *bound < target && VertexBound::Fits(tree.graph())) {
    search.points = std::make_unique<VertexBound>(problem, tree);
    bound = std::max(*bound, search.points->Search(target, rounds, budget));
  }
  tree.Clear(budget);
  return bound;
}

}  // namespace

BoundSearch::BoundSearch() = default;
BoundSearch::~BoundSearch() = default;
BoundSearch::BoundSearch(BoundSearch&&) noexcept = default;
BoundSearch& BoundSearch::operator=(BoundSearch&&) noexcept = default;

void BoundSearch::Clear(Budget& budget) {
  if (points) points->Clear(budget);
  points.reset();
}

std::optional<double> LowerBound(const LayerProblem& problem, double target, BoundSearch* search,
                                 double effort, Budget& budget) {
  if (problem.plan->paths.empty()) return RouteCost(problem, {});
  if (budget.ExhaustedNow()) return std::nullopt;
  BoundSearch own;
  BoundSearch& it = search != nullptr ? *search : own;
  const bool goes_on = it.points != nullptr;
  const bool known = goes_on || !it.multipliers.empty();
  const double rounds = VertexRounds(effort);
  std::optional<double> bound;
  if (goes_on) {
    it.points->SetStartAndFinish(problem.start, problem.finish);
    bound = it.points->Search(target, static_cast<int>(kShareOfRoundsOnward * rounds), budget);
    if (budget.was_exhausted() && *bound == 0) return std::nullopt;
  } else {
    bound =
        BoundFromNothing(problem, target, it,
                         static_cast<int>(known ? kShareOfRoundsAgain * rounds : rounds), budget);
  }
  own.Clear(budget);
  if (!bound) return std::nullopt;
  if (*bound < target && effort > 0) {
    if (known) effort *= kShareOfProgrammeAgain;
    bound = std::max(*bound, ProgrammeBound(problem, target, effort, budget).value_or(0));
  }
  return std::min(*bound, target);
}

}  // namespace traverse
