#include "engine/proof/vertices/places.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "engine/base/rng.h"
#include "engine/model/tree/plan_tree.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/owned_problem.h"

namespace traverse {
namespace {

// Contours of 1, 20, 39, ... points; the last has the same point over and over.
testing::OwnedProblem Contours() {
  Rng rng(5);
  std::vector<Path> paths;
  for (int size = 1; size < 60; size += 19) {
    std::vector<Point> points;
    for (int i = 0; i < size; ++i) points.push_back({rng.Unit(), rng.Unit()});
    paths.push_back(MakeContour(std::move(points)));
  }
  paths.push_back(MakeContour(std::vector<Point>(9, Point{1, 2})));
  return testing::OwnedProblem(testing::AnyOrderPlan(std::move(paths)));
}

// Each point of each end is in one place, in order.
void ExpectAllPoints(const EndGraph& graph, const Places& places) {
  for (size_t end = 0; end < graph.ends.size(); ++end) {
    std::vector<Point> points;
    const int of_end = static_cast<int>(end);
    for (int p = places.first(of_end); p < places.first(of_end + 1); ++p) {
      EXPECT_EQ(places.end_of(p), of_end);
      EXPECT_FALSE(places.points(p).empty());
      points.insert(points.end(), places.points(p).begin(), places.points(p).end());
    }
    const auto& all = graph.ends[end].points;
    EXPECT_EQ(points, std::vector<Point>(all.begin(), all.end()));
  }
}

TEST(Places, HaveAllPointsHoweverOftenTheyAreSplit) {
  const testing::OwnedProblem owned = Contours();
  const EndGraph graph{PlanTree(owned.plan())};
  Places places(graph, 3);
  EXPECT_EQ(places.count(), 1 + 3 + 3 + 3 + 1);
  ExpectAllPoints(graph, places);

  for (int before = 0; before < places.count();) {
    before = places.count();
    const std::vector<int> first = places.Split(std::vector<char>(static_cast<size_t>(before), 1));
    EXPECT_EQ(first.size(), static_cast<size_t>(before) + 1);
    EXPECT_EQ(first.back(), places.count());
    ExpectAllPoints(graph, places);
  }
  EXPECT_EQ(places.count(), 1 + 20 + 39 + 58 + 1) << "all but equal points are apart";
}

TEST(Places, AreNoNearerThanTheirNearestPoints) {
  const testing::OwnedProblem owned = Contours();
  const EndGraph graph{PlanTree(owned.plan())};
  const Places places(graph, 4);
  for (int a = 0; a < places.count(); ++a) {
    for (int b = 0; b < places.count(); ++b) {
      for (const Point& p : places.points(a)) {
        for (const Point& q : places.points(b)) {
          EXPECT_LE(places.LeastDistance(a, b), Distance(p, q));
        }
      }
    }
  }
}

}  // namespace
}  // namespace traverse
