#include "engine/weller/tabu/tabu_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

TabuResult Search(const OwnedProblem& owned, const TabuOptions& options,
                  const LinkRules& rules = {}) {
  Budget budget;
  return TabuSearch(owned.problem, rules, GivenRoute(owned.plan()), options, budget);
}

// Figure 4.3: the origin and four contours, links that are against the neighborhood penalized. The
// shortest sequence Or A C B D breaks B-D; the best that breaks none is Or B C A D of figure 3.8.
TEST(TabuSearch, PrefersTheNeighborhoodAsInFigure43) {
  const OwnedProblem owned(
      testing::AnyOrderPlan({MakeContour({{24, 12}}), MakeContour({{8, 32}}),
                             MakeContour({{36, 30}}), MakeContour({{46, 10}})}));
  SymmetricRelation linked(5);
  const int a = 0, b = 1, c = 2, d = 3, origin = 4;
  linked.Link(origin, a);
  linked.Link(origin, b);
  linked.Link(a, b);
  linked.Link(a, c);
  linked.Link(a, d);
  linked.Link(b, c);
  linked.Link(c, d);
  const LinkRules rules{.node_of = {a, b, c, d}, .start_node = origin, .linked = &linked};

  const TabuResult result = Search(owned, {.diversifications = 20}, rules);

  ASSERT_FALSE(result.elite.empty());
  EXPECT_EQ(result.elite[0].penalized, 0);
  double best = INFINITY;
  for (const auto& order : testing::LegalOrders(owned.plan())) {
    bool keeps = linked.Linked(origin, order[0]);
    for (size_t k = 1; k < 4; ++k) keeps = keeps && linked.Linked(order[k - 1], order[k]);
    if (keeps) best = std::min(best, testing::BestEntries(owned.problem, order).cost);
  }
  EXPECT_NEAR(result.elite[0].cost, best, 1e-9);
}

// What the thesis's search does not do: begin with the order given, go downhill first, forget.
TEST(TabuSearch, AsPublishedCarriesItsListAndBeginsAtRandom) {
  const OwnedProblem owned = testing::RandomProblem(
      5, {.shape = testing::PlanShape::kFlatContours, .min_paths = 12, .max_paths = 12});
  std::vector<TabuStep> forbidden;
  int64_t moves = 0, kept = 0, new_lists = 0;
  TabuOptions options{.diversifications = 40, .patience = 4, .published = true};
  const size_t capacity = static_cast<size_t>(1.5 * 12);
  options.on_move = [&](const TabuStep& step) {
    ++moves;
    new_lists += step.new_intensification;
    const bool tabu = std::any_of(forbidden.begin(), forbidden.end(), [&](const TabuStep& old) {
      return old.first == step.first && old.second == step.second &&
             step.iteration < old.tabu_until;
    });
    kept += tabu && !step.aspired;
    forbidden.push_back(step);
    if (forbidden.size() > capacity) forbidden.erase(forbidden.begin());
  };

  const TabuResult result = Search(owned, options);

  EXPECT_EQ(result.diversifications, 40);
  EXPECT_LE(new_lists, 1);
  EXPECT_EQ(kept, 0);
  EXPECT_GE(moves, 40 * 4);  // patience, from wherever it began
  EXPECT_OK(ValidateRoute(owned.plan(), result.elite.front().route));
  // Two orders there are, forty searches all the same.
  const OwnedProblem two(testing::FlatPlan(2));
  EXPECT_EQ(Search(two, options).diversifications, 40);
}

// A raster alone has no one to be swapped with: its two nodes are.
TEST(TabuSearch, AsPublishedSwapsTheEndsOfARaster) {
  const OwnedProblem owned(
      testing::AnyOrderPlan({MakeOpenPath({9, 0}, {1, 0}), MakeOpenPath({10, 0}, {19, 0})}));

  const TabuResult result = Search(owned, {.diversifications = 10, .published = true});

  EXPECT_EQ(result.elite.front().route, (Route{{0, 1}, {1, 0}}));
}

TEST(TabuSearch, FindsTheOptimumOfSmallPlans) {
  int found = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.min_paths = 1, .max_paths = 6});

    const TabuResult result = Search(owned, {.diversifications = 50});

    ASSERT_FALSE(result.elite.empty());
    const double optimum = testing::BruteForce(owned.problem).cost;
    EXPECT_GE(result.elite[0].cost, optimum - 1e-9);
    found += result.elite[0].cost <= optimum + 1e-9;
  }
  EXPECT_GE(found, 195);
}

TEST(TabuSearch, PenaltiesNeverSurvive) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.min_paths = 1, .max_paths = 12});
    const SymmetricRelation nobody(static_cast<int>(owned.plan().paths.size()));
    LinkRules rules{.linked = &nobody};
    for (int p = 0; p < nobody.node_count(); ++p) rules.node_of.push_back(p);
    for (const auto diversification :
         {TabuOptions::Diversification::kRandom, TabuOptions::Diversification::kSwaps}) {
      const TabuResult result =
          Search(owned, {.diversifications = 10, .diversification = diversification}, rules);

      ASSERT_FALSE(result.elite.empty());
      for (const TabuElite& elite : result.elite) {
        EXPECT_OK(ValidateRoute(owned.plan(), elite.route));
        EXPECT_NEAR(elite.cost, RouteCost(owned.problem, elite.route), 1e-6);
        EXPECT_EQ(elite.penalized, static_cast<int>(elite.route.size()) - 1);
      }
    }
  }
}

// Keeps its own list of what is forbidden.
TEST(TabuSearch, TakesNoTabuMoveWithoutAspiration) {
  for (const bool reactive : {false, true}) {
    for (uint64_t seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(absl::StrCat("seed ", seed));
      const OwnedProblem owned = testing::RandomProblem(
          seed, {.shape = testing::PlanShape::kFlatContours, .min_paths = 5, .max_paths = 12});
      std::vector<TabuStep> forbidden;
      int aspirations = 0;
      TabuOptions options{.diversifications = 60, .patience = 12, .reactive = reactive};
      const size_t capacity =
          static_cast<size_t>(std::ceil(1.5 * double(owned.plan().paths.size())));
      options.on_move = [&](const TabuStep& step) {
        if (step.new_intensification) forbidden.clear();
        const bool tabu =
            std::any_of(forbidden.begin(), forbidden.end(), [&](const TabuStep& earlier) {
              return earlier.first == step.first && earlier.second == step.second &&
                     step.iteration < earlier.tabu_until;
            });
        EXPECT_EQ(tabu, step.aspired);
        if (tabu) {
          EXPECT_LT(step.cost, step.best);
        }
        aspirations += tabu;
        EXPECT_GE(step.tabu_until, step.iteration + 1 + 6);  // a tenth of the diversifications
        forbidden.push_back(step);
        if (forbidden.size() > capacity) forbidden.erase(forbidden.begin());
      };

      const TabuResult result = Search(owned, options);

      EXPECT_EQ(result.aspirations, aspirations);
    }
  }
}

TEST(TabuSearch, EliteIsSortedAndDistinct) {
  const OwnedProblem owned = testing::RandomProblem(
      3, {.shape = testing::PlanShape::kFlatContours, .min_paths = 12, .max_paths = 12});

  const TabuResult result = Search(owned, {.diversifications = 100, .elite = 4});

  ASSERT_EQ(result.elite.size(), 4u);
  for (size_t i = 1; i < 4; ++i) EXPECT_GT(result.elite[i].cost, result.elite[i - 1].cost);
}

TEST(TabuSearch, IsDeterministicByItsSeed) {
  OwnedProblem owned = testing::RandomProblem(
      5, {.shape = testing::PlanShape::kFlatContours, .min_paths = 12, .max_paths = 12});
  const TabuResult first = Search(owned, {.diversifications = 5});
  const TabuResult again = Search(owned, {.diversifications = 5});
  owned.problem.seed = 99;
  const TabuResult other = Search(owned, {.diversifications = 5});

  EXPECT_EQ(first.elite[0].route, again.elite[0].route);
  EXPECT_EQ(first.moves, again.moves);
  EXPECT_NE(first.moves, other.moves);
}

TEST(TabuSearch, StopsWithTheBudgetButHasARoute) {
  CancelToken cancel;
  cancel.Cancel();
  Budget budget(&cancel);
  const OwnedProblem owned = testing::RandomProblem(1, {.min_paths = 5, .max_paths = 12});

  const TabuResult result = TabuSearch(owned.problem, {}, GivenRoute(owned.plan()), {}, budget);

  ASSERT_EQ(result.elite.size(), 1u);
  EXPECT_OK(ValidateRoute(owned.plan(), result.elite[0].route));
  EXPECT_EQ(result.diversifications, 0);
}

TEST(TabuSearch, EndsAfterSoManyEvaluations) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(5, 5)));

  const TabuResult limited = Search(owned, {.diversifications = 1000, .evaluations = 20000});
  const TabuResult unlimited = Search(owned, {.diversifications = 20});

  ASSERT_OK(ValidateRoute(owned.plan(), limited.elite.at(0).route));
  EXPECT_GE(limited.evaluations, 20000);
  EXPECT_LT(limited.evaluations, 20000 + 2 * 25 * 25);  // rows are begun, not cut short
  EXPECT_LT(limited.diversifications, 1000);
  EXPECT_EQ(unlimited.diversifications, 20);
}

TEST(TabuSearch, NodesWithManyChildrenTryNearSwaps) {
  std::vector<Path> paths;
  for (int i = 0; i < 60; ++i) paths.push_back(MakeContour({{double(i * 37 % 60), 0}}));
  const OwnedProblem owned(testing::AnyOrderPlan(paths));

  const TabuResult result = Search(owned, {.diversifications = 30});

  EXPECT_LT(result.elite[0].cost, RouteCost(owned.problem, GivenRoute(owned.plan())) / 5);
}

}  // namespace
}  // namespace traverse
