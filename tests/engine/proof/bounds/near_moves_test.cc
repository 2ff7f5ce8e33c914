#include "engine/proof/bounds/near_moves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "engine/model/tree/plan_tree.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/owned_problem.h"

namespace traverse {
namespace {

// Two contours of `points` points each, on two lines 10 apart.
testing::OwnedProblem TwoLines(int points) {
  std::vector<Path> paths;
  for (const double y : {0.0, 10.0}) {
    std::vector<Point> line;
    for (int i = 0; i < points; ++i) line.push_back({static_cast<double>(i), y});
    paths.push_back(MakeContour(std::move(line)));
  }
  return testing::OwnedProblem(testing::AnyOrderPlan(std::move(paths)));
}

TEST(NearMoves, APairHasAllMovesAndEachOnce) {
  const testing::OwnedProblem owned = TwoLines(3);
  const EndGraph graph{PlanTree(owned.plan())};
  const TravelCost cost(owned.problem);
  NearMoves moves(graph, cost);
  const auto& members = graph.junctions[0].members;

  moves.AddPair(0, members[0], members[1]);
  moves.AddPair(0, members[1], members[0]);
  moves.AddMove(0, members[1], members[0],
                {moves.first(members[1].end), moves.first(members[0].end)});

  EXPECT_EQ(moves.groups().size(), 1u);
  EXPECT_EQ(moves.moves().size(), 9u);
  for (const NearMoves::Move& move : moves.moves()) {
    const auto place = [&](int point) {
      const int end = moves.end_of(point);
      return graph.ends[static_cast<size_t>(end)]
          .points[static_cast<size_t>(point - moves.first(end))];
    };
    EXPECT_DOUBLE_EQ(move.cost, cost.Base(place(move.points[0]), place(move.points[1])));
  }
}

TEST(NearMoves, OfManyPointsEachHasItsNearestMoves) {
  const testing::OwnedProblem owned = TwoLines(60);
  const EndGraph graph{PlanTree(owned.plan())};
  const TravelCost cost(owned.problem);
  NearMoves moves(graph, cost);
  const auto& members = graph.junctions[0].members;

  moves.AddPair(0, members[0], members[1]);

  std::set<std::pair<int, int>> known;
  for (const NearMoves::Move& move : moves.moves()) {
    known.insert(std::minmax(move.points[0], move.points[1]));
  }
  EXPECT_EQ(known.size(), moves.moves().size());
  EXPECT_LT(known.size(), 60u * 8);
  for (int i = 0; i < 60; ++i) EXPECT_TRUE(known.contains({i, 60 + i})) << i;
  EXPECT_FALSE(known.contains({0, 119}) || known.contains({59, 60}));

  moves.AddMove(0, members[0], members[1],
                {moves.first(members[0].end), moves.first(members[1].end) + 59});

  EXPECT_EQ(moves.groups().size(), 2u);
  EXPECT_EQ(moves.moves().size(), known.size() + 1);
}

}  // namespace
}  // namespace traverse
