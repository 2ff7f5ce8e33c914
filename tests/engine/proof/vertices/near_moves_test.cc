#include "engine/proof/vertices/near_moves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/model/tree/plan_tree.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/owned_problem.h"

namespace traverse {
namespace {

// Two contours of so many points, on two lines 10 apart.
testing::OwnedProblem TwoLines(int first, int second) {
  std::vector<Path> paths;
  for (const double y : {0.0, 10.0}) {
    std::vector<Point> line;
    for (int i = 0; i < (y == 0 ? first : second); ++i) line.push_back({static_cast<double>(i), y});
    paths.push_back(MakeContour(std::move(line)));
  }
  return testing::OwnedProblem(testing::AnyOrderPlan(std::move(paths)));
}

TEST(NearMoves, APairHasAllMovesAndEachOnce) {
  const testing::OwnedProblem owned = TwoLines(3, 4);
  const EndGraph graph{PlanTree(owned.plan())};
  const TravelCost cost(owned.problem);
  NearMoves moves(graph, cost, 1000);
  const auto& members = graph.junctions[0].members;

  moves.AddPair(0, members[0], members[1]);
  moves.AddPair(0, members[1], members[0]);

  ASSERT_EQ(moves.groups().size(), 1u);
  EXPECT_EQ(moves.Find(0, 1), &moves.groups()[0]);
  EXPECT_EQ(moves.Find(1, 0), &moves.groups()[0]);
  EXPECT_EQ(moves.Find(0, 0), nullptr);
  EXPECT_EQ(moves.moves().size(), 12u);
  for (const NearMoves::Move& move : moves.moves()) {
    const auto place = [&](int point) {
      const int end = moves.end_of(point);
      return graph.ends[static_cast<size_t>(end)]
          .points[static_cast<size_t>(point - moves.first(end))];
    };
    for (const int k : {0, 1}) {
      const size_t index = moves.IndexOf(moves.groups()[0], move.points[k], move.points[1 - k]);
      EXPECT_EQ(&moves.moves()[index], &move);
    }
    EXPECT_DOUBLE_EQ(move.cost, cost.Base(place(move.points[0]), place(move.points[1])));
  }
}

TEST(NearMoves, OfPlacesCostAsMuchAsTheirNearestPoints) {
  const testing::OwnedProblem owned = TwoLines(8, 8);
  const EndGraph graph{PlanTree(owned.plan())};
  const TravelCost cost(owned.problem);
  NearMoves moves(graph, cost, 2);
  const auto& members = graph.junctions[0].members;
  moves.AddPair(0, members[0], members[1]);
  ASSERT_EQ(moves.point_count(), 4);
  ASSERT_EQ(moves.moves().size(), 4u);

  std::vector<size_t> parents;
  const std::vector<int> became = moves.Split({1, 0, 0, 1}, parents);

  EXPECT_EQ(became, (std::vector<int>{0, 2, 3, 4, 6}));
  ASSERT_EQ(moves.moves().size(), 9u);
  // The second end is the first of the group.
  EXPECT_EQ(parents, (std::vector<size_t>{0, 0, 1, 2, 2, 3, 2, 2, 3}));
  EXPECT_EQ(moves.line_count(), 6u);
  for (const NearMoves::Move& move : moves.moves()) {
    const auto from = moves.places().points(move.points[0]);
    const auto to = moves.places().points(move.points[1]);
    double least = 1e9;
    for (const Point& p : from) {
      for (const Point& q : to) least = std::min(least, cost.Base(p, q));
    }
    EXPECT_DOUBLE_EQ(move.cost, least);
  }
}

}  // namespace
}  // namespace traverse
