#include "engine/cost/neighbor_lists.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"

namespace traverse {
namespace {

using Member = NeighborLists::Member;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

PointGroups RandomGroups(Rng& rng, int count, int most_points) {
  PointGroups groups;
  for (int g = 0; g < count; ++g) {
    const Point center{rng.Unit() * 100, rng.Unit() * 100};
    for (int i = rng.Between(1, most_points); i > 0; --i) {
      groups.points.push_back({center.x + rng.Unit() * 10, center.y + rng.Unit() * 10});
    }
    groups.Close();
  }
  return groups;
}

double BruteForceDistance(const PointGroups& groups, int a, int b) {
  double least = std::numeric_limits<double>::infinity();
  for (const Point p : groups.of(a)) {
    for (const Point q : groups.of(b)) least = std::min(least, Distance(p, q));
  }
  return least;
}

std::vector<int> GroupsOf(absl::Span<const NeighborLists::Neighbor> list) {
  std::vector<int> groups;
  for (const auto& neighbor : list) groups.push_back(neighbor.group);
  return groups;
}

TEST(NeighborLists, AreExactForGroupsNoLargerThanASample) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const PointGroups groups = RandomGroups(rng, 40, static_cast<int>(NeighborLists::kSamples));
    std::vector<Member> members;
    for (int g = 0; g < groups.size(); ++g) members.push_back({g, g / 2});
    Budget budget;
    NeighborLists lists(groups);

    lists.FindAmong(members, 6, budget);
    lists.Seal();

    for (int g = 0; g < groups.size(); ++g) {
      std::vector<double> expected;
      for (int h = 0; h < groups.size(); ++h) {
        if (h / 2 != g / 2) expected.push_back(BruteForceDistance(groups, g, h));
      }
      std::sort(expected.begin(), expected.end());
      ASSERT_EQ(lists.of(g).size(), 6u);
      for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(lists.of(g)[k].distance_mm, expected[k], 1e-4);
    }
  }
}

// Contours with many vertices: the nearest two are nearly always found.
TEST(NeighborLists, RefineDistancesOfLargeGroups) {
  PointGroups groups;
  for (const double x : {0.0, 25.0, 80.0}) {
    for (int i = 0; i < 100; ++i) {
      const double angle = 2 * 3.14159265358979 * (i + 0.5) / 100;
      groups.points.push_back({x + 10 * std::cos(angle), 10 * std::sin(angle)});
    }
    groups.Close();
  }
  Budget budget;
  NeighborLists lists(groups);

  lists.FindAmong(std::vector<Member>{{0, 0}, {1, 1}, {2, 2}}, 2, budget);
  lists.Seal();

  EXPECT_THAT(GroupsOf(lists.of(1)), ElementsAre(0, 2));
  EXPECT_NEAR(lists.of(0)[0].distance_mm, BruteForceDistance(groups, 0, 1), 1e-4);
}

TEST(NeighborLists, MergeSearchesOfOneGroup) {
  PointGroups groups;
  for (const double x : {0.0, 1.0, 3.0, 7.0}) {
    groups.points.push_back({x, 0});
    groups.Close();
  }
  Budget budget;
  NeighborLists lists(groups);

  lists.FindAmong(std::vector<Member>{{0, 0}, {3, 1}}, 5, budget);
  lists.FindAmong(std::vector<Member>{{0, 0}, {1, 1}, {2, 2}}, 1, budget);
  lists.Seal();

  EXPECT_THAT(GroupsOf(lists.of(0)), ElementsAre(1, 3));
  EXPECT_THAT(GroupsOf(lists.of(3)), ElementsAre(0));
}

TEST(NeighborLists, AreEmptyAfterTheDeadline) {
  PointGroups groups;
  groups.points = {{0, 0}, {1, 0}};
  groups.first = {0, 1, 2};
  Budget late(nullptr, Budget::Clock::now() - std::chrono::seconds(1));
  NeighborLists lists(groups);

  lists.FindAmong(std::vector<Member>{{0, 0}, {1, 1}}, 1, late);
  lists.Seal();

  EXPECT_THAT(lists.of(0), IsEmpty());
  EXPECT_THAT(lists.of(1), IsEmpty());
}

}  // namespace
}  // namespace traverse
