// The mixed integer programmes of the thesis against brute force, and the layered graph of step 3
// against the programme that the thesis has for it.

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "engine/weller/milp/contour_milp.h"
#include "engine/weller/milp/raster_milp.h"
#include "engine/weller/steps/contour_route.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

constexpr double kTolerance = 1e-6;

OwnedProblem Problem(Plan plan, Rng& rng) {
  OwnedProblem owned(std::move(plan), {100 * rng.Unit(), 100 * rng.Unit()});
  owned.problem.cost = testing::RandomCost(rng);
  return owned;
}

OwnedProblem ContourProblem(Rng& rng, int contours) {
  std::vector<Path> paths;
  for (int i = 0; i < contours; ++i) {
    Path path = testing::RandomContour(rng, {.max_vertices = 4});
    path.allowed.clear();
    paths.push_back(std::move(path));
  }
  return Problem(testing::AnyOrderPlan(std::move(paths)), rng);
}

SymmetricRelation AllLinked(int nodes) {
  SymmetricRelation linked(nodes);
  for (int i = 0; i < nodes; ++i) {
    for (int j = i + 1; j < nodes; ++j) linked.Link(i, j);
  }
  return linked;
}

TEST(ContourMilp, IsTheBestSequence) {
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const int contours = rng.Between(1, 4);
    const OwnedProblem owned = ContourProblem(rng, contours);
    const double best = testing::BruteForce(owned.problem).cost;
    for (const bool strengthened : {false, true}) {
      Budget budget;

      const MilpRoute found = SolveContourMilp(owned.problem, AllLinked(contours + 1), {},
                                               {.gap = 0, .strengthened = strengthened}, budget);

      EXPECT_TRUE(found.complete);
      ASSERT_OK(ValidateRoute(owned.plan(), found.route));
      EXPECT_NEAR(RouteCost(owned.problem, found.route), best, kTolerance * (1 + best));
      EXPECT_NEAR(found.value, best, kTolerance * (1 + best));
    }
  }
}

// Contours in a row, of which only those further apart are linked: 0 - 2 - 1 - 3 from the left.
TEST(ContourMilp, KeepsToNeighbors) {
  const OwnedProblem owned(testing::FlatPlan(4));
  SymmetricRelation linked(5);
  linked.Link(4, 0);
  linked.Link(0, 2);
  linked.Link(2, 1);
  linked.Link(1, 3);
  Budget budget;

  const MilpRoute free = SolveContourMilp(owned.problem, linked, {}, {.gap = 0}, budget);
  const MilpRoute known =
      SolveContourMilp(owned.problem, linked, GivenRoute(owned.plan()), {.gap = 0}, budget);

  EXPECT_EQ(free.route, (Route{{0, 0}, {2, 0}, {1, 0}, {3, 0}}));
  EXPECT_EQ(known.route, GivenRoute(owned.plan()));  // whose moves count as neighbors
}

TEST(ContourMilp, SaysWhenNeighborsLeaveNoSequence) {
  const OwnedProblem owned(testing::FlatPlan(3));
  SymmetricRelation linked(4);
  linked.Link(3, 0);
  linked.Link(0, 1);
  Budget budget;

  const MilpRoute found = SolveContourMilp(owned.problem, linked, {}, {.gap = 0}, budget);

  EXPECT_TRUE(found.complete);
  EXPECT_TRUE(found.route.empty());
}

// any_order over groups of any_order over open paths.
OwnedProblem RasterProblem(Rng& rng, std::vector<int>& group_of) {
  Plan plan;
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
  const int groups = rng.Between(1, 3);
  for (int group = 0; group < groups; ++group) {
    const size_t parent = plan.nodes.size();
    plan.nodes[0].children.push_back(static_cast<int>(parent));
    plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
    for (int i = rng.Between(1, 2); i > 0; --i) {
      plan.nodes[parent].children.push_back(static_cast<int>(plan.nodes.size()));
      plan.nodes.push_back(
          PlanNode{PlanNode::Kind::kPath, static_cast<int>(plan.paths.size()), {}, {}});
      plan.paths.push_back(testing::RandomOpenPath(rng));
      group_of.push_back(group);
    }
  }
  OwnedProblem owned = Problem(std::move(plan), rng);
  if (rng.Between(0, 1) == 1) owned.problem.finish = Point{50, 50};
  return owned;
}

TEST(RasterMilp, IsTheBestRouteThatKeepsIslandsTogether) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    std::vector<int> group_of;
    const OwnedProblem owned = RasterProblem(rng, group_of);
    const double best = testing::BruteForce(owned.problem).cost;
    Budget budget;

    const MilpRoute found =
        SolveRasterMilp(owned.problem, {group_of, -1, nullptr}, {}, {.gap = 0}, budget);

    EXPECT_TRUE(found.complete);
    ASSERT_OK(ValidateRoute(owned.plan(), found.route));
    EXPECT_NEAR(RouteCost(owned.problem, found.route), best, kTolerance * (1 + best));
    EXPECT_NEAR(found.value, best, kTolerance * (1 + best));
  }
}

// Three islands in a row; the first and the second are no neighbors.
TEST(RasterMilp, KeepsToNeighboringIslands) {
  const OwnedProblem owned(testing::AnyOrderPlan(
      {MakeOpenPath({1, 0}, {1, 5}), MakeOpenPath({2, 0}, {2, 5}), MakeOpenPath({3, 0}, {3, 5})}));
  SymmetricRelation linked(3);
  linked.Link(0, 2);
  linked.Link(1, 2);
  Budget budget;

  const MilpRoute found =
      SolveRasterMilp(owned.problem, {{0, 1, 2}, 0, &linked}, {}, {.gap = 0}, budget);

  EXPECT_EQ(found.route, (Route{{0, 0}, {2, 1}, {1, 0}}));
}

// Thesis 4.8-4.13, the columns of pairs of positions that do not follow each other left out.
double StepThreeByMilp(const Plan& plan, const std::vector<int>& order,
                       const std::vector<std::vector<int>>& vertices, Point start,
                       const TravelCost& travel) {
  MixedProgram program;
  std::vector<int> last_ranks = {program.AddBinary(0, true)};
  std::vector<Point> last_points = {start};
  for (size_t k = 0; k < order.size(); ++k) {
    std::vector<int> ranks;
    std::vector<Point> points;
    MixedProgram::Entries one;  // (4.9)
    for (const int vertex : vertices[k]) {
      points.push_back(
          plan.paths[static_cast<size_t>(order[k])].points[static_cast<size_t>(vertex)]);
      ranks.push_back(program.AddBinary(0));
      one.Add(ranks.back(), 1);
    }
    program.AddRow(1, 1, one);
    MixedProgram::Entries one_link;                                 // (4.12)
    std::vector<MixedProgram::Entries> of_last(last_ranks.size());  // (4.11)
    std::vector<MixedProgram::Entries> of_next(ranks.size());       // (4.11)
    for (size_t p = 0; p < last_ranks.size(); ++p) {
      for (size_t q = 0; q < ranks.size(); ++q) {
        const int link = program.AddBinary(travel(last_points[p], points[q]));
        MixedProgram::Entries both;  // (4.10)
        both.Add(link, 1);
        both.Add(last_ranks[p], -1);
        both.Add(ranks[q], -1);
        program.AddRow(-1, MixedProgram::kInfinity, both);
        one_link.Add(link, 1);
        of_last[p].Add(link, 1);
        of_next[q].Add(link, 1);
      }
    }
    program.AddRow(1, 1, one_link);
    for (size_t p = 0; p < last_ranks.size(); ++p) {
      of_last[p].Add(last_ranks[p], -1);
      program.AddRow(-MixedProgram::kInfinity, 0, of_last[p]);
    }
    for (size_t q = 0; q < ranks.size(); ++q) {
      of_next[q].Add(ranks[q], -1);
      program.AddRow(-MixedProgram::kInfinity, 0, of_next[q]);
    }
    last_ranks = ranks;
    last_points = points;
  }
  Budget budget;
  return program.Solve({}, {}, budget).value;
}

TEST(ChooseContourPoints, IsTheOptimumOfTheThesisModel) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const OwnedProblem owned = ContourProblem(rng, rng.Between(1, 6));
    const Plan& plan = owned.plan();
    std::vector<int> order;
    for (size_t i = 0; i < plan.paths.size(); ++i) order.push_back(static_cast<int>(i));
    const TravelCost travel(owned.problem.cost);
    const auto vertices = VisiblePointsAlong(plan, order, owned.problem.start, 2.5);

    const Route chosen = ChooseContourPoints(plan, order, vertices, owned.problem.start, travel);

    const double cost = RouteCost(owned.problem, chosen);
    EXPECT_NEAR(cost, StepThreeByMilp(plan, order, vertices, owned.problem.start, travel),
                kTolerance * (1 + cost));
  }
}

}  // namespace
}  // namespace traverse
