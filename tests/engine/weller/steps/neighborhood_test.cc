#include "engine/weller/steps/neighborhood.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/weller/steps/point_reduction.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

// A square contour of side 2 mm.
CircledContour SquareAt(Point center) {
  const auto [x, y] = center;
  return CircleOf(MakeContour({{x - 1, y - 1}, {x + 1, y - 1}, {x + 1, y + 1}, {x - 1, y + 1}}),
                  0.5);
}

// Figure 3.7: an origin and four contours. Each circle meets two; A finds C and D, but Or and B
// find A, so that A has four neighbors. Links that figure 4.3 penalizes: Or-C, Or-D, B-D.
enum { kA, kB, kC, kD, kOrigin };
std::vector<CircledContour> Figure37() {
  return {SquareAt({24, 12}), SquareAt({8, 32}), SquareAt({36, 30}), SquareAt({46, 10})};
}

TEST(GrowCircles, MakesTheNeighborhoodsOfFigure37Reciprocal) {
  Budget budget;

  const Neighborhood found = GrowCircles(Figure37(), {0, 0}, {}, budget);

  EXPECT_THAT(found.of(kOrigin), UnorderedElementsAre(kA, kB));
  EXPECT_THAT(found.of(kA), UnorderedElementsAre(kOrigin, kB, kC, kD));
  EXPECT_THAT(found.of(kB), UnorderedElementsAre(kOrigin, kA, kC));
  EXPECT_THAT(found.of(kC), UnorderedElementsAre(kA, kB, kD));
  EXPECT_THAT(found.of(kD), UnorderedElementsAre(kA, kC));
  EXPECT_FALSE(found.Linked(kOrigin, kC));
  EXPECT_FALSE(found.Linked(kD, kB));
}

// On a line at x = 10, 20, 30, 41, 80: what a circle meets depends on where its growth stops.
TEST(GrowCircles, TakesAllThatTheLastStepMeets) {
  std::vector<CircledContour> line;
  for (const double x : {10, 20, 30, 41, 80}) line.push_back({{{x, 0}}, {x, 0}, 0});
  Budget budget;

  // From 10 with radii 0, 5, ..., 20: 20 and 30. With a first radius of 35 also 41.
  EXPECT_THAT(GrowCircles(line, {1000, 0}, {}, budget).of(0), UnorderedElementsAre(1, 2));
  EXPECT_THAT(GrowCircles(line, {1000, 0}, {.first_radius_mm = 35}, budget).of(0),
              UnorderedElementsAre(1, 2, 3));
  // In steps of 32 mm it goes from 0 to 32, where it meets the same four as 35 does.
  EXPECT_THAT(GrowCircles(line, {1000, 0}, {.step_mm = 32}, budget).of(0),
              UnorderedElementsAre(1, 2, 3));
  EXPECT_THAT(GrowCircles(line, {1000, 0}, {.neighbors = 9}, budget).of(0),
              UnorderedElementsAre(1, 2, 3, 4, 5));
}

TEST(GrowCircles, OfLonelyContours) {
  Budget budget;

  EXPECT_THAT(GrowCircles({SquareAt({5, 5})}, {0, 0}, {}, budget).of(0), ElementsAre(1));
  EXPECT_EQ(GrowCircles({}, {0, 0}, {}, budget).node_count(), 1);
}

// Two clusters of three; the origin is part of the left one. 3 and 4 are nearest to each other.
TEST(LinkClusters, LinksWhereTheClustersAreNearest) {
  const std::vector<CircledContour> contours = {SquareAt({10, 0}), SquareAt({10, 9}),
                                                SquareAt({18, 4}), SquareAt({60, 4}),
                                                SquareAt({68, 0}), SquareAt({68, 9})};
  Budget budget;
  Neighborhood found = GrowCircles(contours, {0, 4}, {}, budget);
  ASSERT_THAT(found.Components(), ElementsAre(0, 0, 0, 1, 1, 1, 0));

  LinkClusters(contours, {0, 4}, found, budget);

  EXPECT_THAT(found.Components(), Each(0));
  EXPECT_TRUE(found.Linked(2, 3));
  EXPECT_EQ(found.of(3).size(), 3u);
}

// Step 2, line 8a: "for all the clusters there are". Three clusters of three at the corners of a
// triangle: the tree of the shortest links would leave out the longest, right to top.
TEST(LinkClusters, LinksEachTwoClusters) {
  std::vector<CircledContour> contours;
  for (const Point at : {Point{10, 5}, Point{70, 5}, Point{40, 65}}) {
    for (const Point by : {Point{0, 0}, Point{7, 0}, Point{3, 7}}) {
      contours.push_back(SquareAt({at.x + by.x, at.y + by.y}));
    }
  }
  Budget budget;
  Neighborhood found = GrowCircles(contours, {0, 4}, {}, budget);
  ASSERT_THAT(found.Components(), ElementsAre(0, 0, 0, 1, 1, 1, 2, 2, 2, 0));

  LinkClusters(contours, {0, 4}, found, budget);

  EXPECT_TRUE(found.Linked(1, 3));  // left to right
  EXPECT_TRUE(found.Linked(2, 6));  // left to top
  EXPECT_TRUE(found.Linked(5, 7));  // right to top
  EXPECT_EQ(found.of(4).size(), 2u);
}

TEST(LinkClusters, LinksAnyTwoClustersWhereTheyAreNearest) {
  constexpr int kClusters = 4;
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    std::vector<Point> points;
    std::vector<CircledContour> contours;
    for (int i = 0; i < 15; ++i) {
      points.push_back({100 * rng.Unit(), 100 * rng.Unit()});
      contours.push_back({{points.back()}, points.back(), 0});
    }
    points.push_back({0, 0});  // the origin
    Neighborhood found(static_cast<int>(points.size()));
    for (int i = kClusters; i < found.node_count(); ++i) found.Link(i - kClusters, i);
    Budget budget;

    LinkClusters(contours, points.back(), found, budget);

    for (int a = 0; a < kClusters; ++a) {
      for (int b = a + 1; b < kClusters; ++b) {
        std::tuple<double, int, int> nearest{std::numeric_limits<double>::infinity(), 0, 0};
        for (int i = a; i < found.node_count(); i += kClusters) {
          for (int j = b; j < found.node_count(); j += kClusters) {
            const double distance =
                Distance(points[static_cast<size_t>(i)], points[static_cast<size_t>(j)]);
            nearest = std::min(nearest, {distance, i, j});
          }
        }
        EXPECT_TRUE(found.Linked(std::get<1>(nearest), std::get<2>(nearest)));
      }
    }
  }
}

// More clusters than are linked two by two: pairs of contours far from each other.
TEST(LinkClusters, LinksManyClustersAsATree) {
  std::vector<CircledContour> contours;
  for (int i = 0; i < 300; ++i) {
    contours.push_back(SquareAt({100.0 * i + i % 7, 0}));
    contours.push_back(SquareAt({100.0 * i + i % 7, 3}));
  }
  Budget budget;
  Neighborhood found = GrowCircles(contours, {-50, 0}, {.neighbors = 1}, budget);
  ASSERT_EQ(found.Components().back(), 0);
  LinkClusters(contours, {-50, 0}, found, budget);

  EXPECT_THAT(found.Components(), Each(0));
  for (int i = 0; i < found.node_count(); ++i) EXPECT_LE(found.of(i).size(), 4u);
}

// By Prim's algorithm: the length of the shortest tree over the points.
double LengthOfShortestTree(const std::vector<Point>& points) {
  std::vector<double> distance(points.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> linked(points.size());
  distance[0] = 0;
  double length = 0;
  for (size_t round = 0; round < points.size(); ++round) {
    size_t next = points.size();
    for (size_t i = 0; i < points.size(); ++i) {
      if (!linked[i] && (next == points.size() || distance[i] < distance[next])) next = i;
    }
    linked[next] = true;
    length += distance[next];
    for (size_t i = 0; i < points.size(); ++i) {
      distance[i] = std::min(distance[i], Distance(points[next], points[i]));
    }
  }
  return length;
}

TEST(LinkClusters, TheTreeOfManyClustersIsTheShortest) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    std::vector<Point> points;
    std::vector<CircledContour> contours;
    for (int i = 0; i < 210; ++i) {
      points.push_back({300 * rng.Unit(), 300 * rng.Unit()});
      contours.push_back({{points.back()}, points.back(), 0});
    }
    const Point origin{-20, -20};
    points.push_back(origin);
    Neighborhood found(static_cast<int>(points.size()));
    Budget budget;

    LinkClusters(contours, origin, found, budget);

    double length = 0;
    for (int a = 0; a < found.node_count(); ++a) {
      for (const int b : found.of(a)) {
        if (a < b)
          length += Distance(points[static_cast<size_t>(a)], points[static_cast<size_t>(b)]);
      }
    }
    EXPECT_NEAR(length, LengthOfShortestTree(points), 1e-6);
  }
}

TEST(Neighborhoods, AreSymmetricAndConnected) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    std::vector<CircledContour> contours;
    for (int i = rng.Between(0, 40); i > 0; --i) {
      contours.push_back(CircleOf(testing::RandomContour(rng), 2.5));
    }
    const NeighborhoodOptions options{.neighbors = rng.Between(1, 3),
                                      .step_mm = 1 + rng.Unit() * 9};
    const Point origin{rng.Unit() * 100, rng.Unit() * 100};
    Budget budget;

    Neighborhood found = GrowCircles(contours, origin, options, budget);
    LinkClusters(contours, origin, found, budget);

    EXPECT_THAT(found.Components(), Each(0));
    const int least = std::min(options.neighbors, static_cast<int>(contours.size()) - 1);
    for (int a = 0; a < found.node_count(); ++a) {
      EXPECT_GE(static_cast<int>(found.of(a).size()), least);
      EXPECT_FALSE(found.Linked(a, a));
      for (const int b : found.of(a)) EXPECT_TRUE(found.Linked(b, a) && found.Linked(a, b));
    }
  }
}

TEST(Neighborhoods, StopWithTheBudget) {
  CancelToken cancel;
  cancel.Cancel();
  Budget budget(&cancel);

  Neighborhood found = GrowCircles(Figure37(), {0, 0}, {}, budget);
  LinkClusters(Figure37(), {0, 0}, found, budget);

  EXPECT_EQ(found.of(kA).size(), 0u);
}

TEST(IslandNeighborhood, JoinsIslandsWhoseContoursAreNeighbors) {
  const Plan plan = SequentialPlan({{{MakeContour({{0, 0}}), MakeContour({{1, 0}})}, {}},
                                    {{MakeContour({{5, 0}})}, {}},
                                    {{MakeContour({{9, 0}})}, {}}});
  Neighborhood contours(4);  // of paths 1, 2, 3 and the origin
  contours.Link(0, 1);
  contours.Link(1, 2);
  contours.Link(0, 3);

  const Neighborhood islands = IslandNeighborhood(IslandsOf(plan), {1, 2, 3}, contours);

  EXPECT_TRUE(islands.Linked(0, 1));
  EXPECT_TRUE(islands.Linked(1, 2));
  EXPECT_FALSE(islands.Linked(0, 2));
}

}  // namespace
}  // namespace traverse
