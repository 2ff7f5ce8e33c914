#include "engine/cost/entry_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

std::vector<int> GivenPaths(const Plan& plan) {
  std::vector<int> paths;
  for (const Visit& visit : GivenRoute(plan)) paths.push_back(visit.path);
  return paths;
}

TEST(EntryChoice, FindsTheVerticesThatFaceEachOther) {
  const Plan plan =
      AnyOrderPlan({MakeContour({{0, 0}, {1, 0}, {0.5, 9}}),
                    MakeContour({{4, 2}, {3, 0}, {3.5, 9}}), MakeOpenPath({9, 0}, {5, 0})});
  const EntryTable table(plan);
  EntryChoice choice(table, TravelCost({}));
  std::vector<int> entries(3);

  const double cost = choice.Choose({0.5, -1}, {0, 1, 2}, std::nullopt, absl::MakeSpan(entries));

  EXPECT_EQ(table.VisitOf(entries[0]), (Visit{0, 1}));
  EXPECT_EQ(table.VisitOf(entries[1]), (Visit{1, 1}));
  EXPECT_EQ(table.VisitOf(entries[2]), (Visit{2, 1}));
  EXPECT_DOUBLE_EQ(cost, Distance({0.5, -1}, {1, 0}) + 3 + 1);
}

TEST(EntryChoice, IsThatOfBruteForce) {
  for (uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 9, .max_vertices = 12});
    const EntryTable table(owned.plan());
    EntryChoice choice(table, TravelCost(owned.problem.cost));
    const std::vector<int> paths = GivenPaths(owned.plan());
    std::vector<int> entries(paths.size());

    const double cost =
        choice.Choose(owned.problem.start, paths, owned.problem.finish, absl::MakeSpan(entries));

    Route route;
    for (const int entry : entries) route.push_back(table.VisitOf(entry));
    EXPECT_NEAR(cost, BestEntries(owned.problem, paths).cost, 1e-9);
    EXPECT_NEAR(cost, RouteCost(owned.problem, route), 1e-9);
  }
}

TEST(EntryChoice, IsThatOfBruteForceForManyVertices) {
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(
        seed, {.shape = PlanShape::kFlatContours, .min_paths = 5, .max_vertices = 900});
    const EntryTable table(owned.plan());
    EntryChoice choice(table, TravelCost(owned.problem.cost));
    const std::vector<int> paths = GivenPaths(owned.plan());
    std::vector<int> entries(paths.size());

    const double cost =
        choice.Choose(owned.problem.start, paths, owned.problem.finish, absl::MakeSpan(entries));

    EXPECT_NEAR(cost, BestEntries(owned.problem, paths).cost, 1e-9);
  }
}

TEST(EntryChoice, ChoosesAStretchBetweenTwoVisitsThatStay) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.min_paths = 6, .max_paths = 9});
    const EntryTable table(owned.plan());
    EntryChoice choice(table, TravelCost(owned.problem.cost));
    Route route = GivenRoute(owned.plan());
    const double before = RouteCost(owned.problem, route);
    const Point from = table.exit(table.EntryOf(route[1]));
    const Point to = table.enter(table.EntryOf(route[5]));
    const std::vector<int> paths = {route[2].path, route[3].path, route[4].path};
    std::vector<int> given, chosen(3);
    for (const int p : {2, 3, 4}) given.push_back(table.EntryOf(route[static_cast<size_t>(p)]));
    const auto stretch_cost = [&](const std::vector<int>& entries) {
      const TravelCost cost(owned.problem.cost);
      return cost(from, table.enter(entries[0])) +
             cost(table.exit(entries[0]), table.enter(entries[1])) +
             cost(table.exit(entries[1]), table.enter(entries[2])) +
             cost(table.exit(entries[2]), to);
    };

    const double cost = choice.Choose(from, paths, to, absl::MakeSpan(chosen));

    EXPECT_NEAR(cost, stretch_cost(chosen), 1e-9);
    for (size_t k = 0; k < 3; ++k) route[k + 2] = table.VisitOf(chosen[k]);
    EXPECT_NEAR(RouteCost(owned.problem, route), before - stretch_cost(given) + cost, 1e-9);
  }
}

TEST(EntryChoice, OfNoPathsIsTheMoveToTheEnd) {
  const EntryTable table(Plan{});
  EntryChoice choice(table, TravelCost({}));

  EXPECT_EQ(choice.Choose({0, 0}, {}, std::nullopt, {}), 0);
  EXPECT_EQ(choice.Choose({0, 0}, {}, Point{3, 4}, {}), 5);
}

}  // namespace
}  // namespace traverse
