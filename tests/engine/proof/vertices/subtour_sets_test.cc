#include "engine/proof/vertices/subtour_sets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/model/tree/plan_tree.h"
#include "engine/proof/vertices/set_finder.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/owned_problem.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;

constexpr int kEnds = 6;
constexpr int kPointsOfEnd = 3;

// Contours of three points each, and all moves between them.
class SubtourSetsTest : public ::testing::Test {
 protected:
  SubtourSetsTest() : owned_(Contours()), graph_(PlanTree(owned_.plan())), cost_(owned_.problem) {
    const auto& members = graph_.junctions[0].members;
    for (size_t a = 0; a < members.size(); ++a) {
      for (size_t b = a + 1; b < members.size(); ++b) moves_.AddPair(0, members[a], members[b]);
    }
    average_.moves.resize(moves_.moves().size());
    average_.points.resize(static_cast<size_t>(moves_.point_count()));
  }

  static Plan Contours() {
    Rng rng(3);
    std::vector<Path> paths;
    for (int c = 0; c < kEnds; ++c) {
      std::vector<Point> points;
      for (int i = 0; i < kPointsOfEnd; ++i) points.push_back({rng.Unit(), rng.Unit()});
      paths.push_back(MakeContour(std::move(points)));
    }
    return testing::AnyOrderPlan(std::move(paths));
  }

  void AddMove(int from, int to, double weight) {
    for (size_t i = 0; i < moves_.moves().size(); ++i) {
      const int* points = moves_.moves()[i].points;
      if (std::minmax(points[0], points[1]) == std::minmax(from, to)) average_.moves[i] += weight;
    }
  }

  // Puts a route through all contours into the average.
  void AddRoute(Rng& rng, double weight) {
    std::vector<int> order(kEnds);
    std::iota(order.begin(), order.end(), 0);
    for (size_t i = order.size(); i-- > 1;)
      std::swap(order[i], order[rng.Below(static_cast<uint32_t>(i) + 1)]);
    int last = -1;
    for (const int end : order) {
      const int point = moves_.first(end) + static_cast<int>(rng.Below(kPointsOfEnd));
      average_.points[static_cast<size_t>(point)] += weight;
      if (last >= 0) AddMove(last, point, weight);
      last = point;
    }
  }

  testing::OwnedProblem owned_;
  const EndGraph graph_;
  const TravelCost cost_;
  NearMoves moves_{graph_, cost_, 1000};
  AverageSolution average_;
};

TEST_F(SubtourSetsTest, NoRouteAndNoAverageOfRoutesViolatesASet) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    std::fill(average_.moves.begin(), average_.moves.end(), 0);
    std::fill(average_.points.begin(), average_.points.end(), 0);
    const int routes = 1 + static_cast<int>(rng.Below(4));
    for (int i = 0; i < routes; ++i) AddRoute(rng, 1.0 / routes);
    SubtourSets sets(moves_);
    for (int tries = 0; tries < 200; ++tries) {
      std::vector<int> points;
      for (int p = 0; p < moves_.point_count(); ++p) {
        if (rng.Below(3) != 0) points.push_back(p);
      }
      EXPECT_FALSE(sets.Add(points, average_, 1e-9));
    }
    Budget budget;
    SetFinder(moves_, average_)
        .Find(
            1e-9, [](const std::vector<int>&) { return ADD_FAILURE(), true; }, budget);
  }
}

// Half of a way around three points, the other half of each contour elsewhere.
TEST_F(SubtourSetsTest, AWayAroundSomePointsOfContoursIsFoundAndPaysForIt) {
  const int a = moves_.first(0);
  const int b = moves_.first(1) + 1;
  const int c = moves_.first(2) + 2;
  for (const int point : {a, b, c}) average_.points[static_cast<size_t>(point)] = 0.5;
  for (const int point : {a + 1, b + 1, c - 1}) average_.points[static_cast<size_t>(point)] = 0.5;
  AddMove(a, b, 0.5);
  AddMove(b, c, 0.5);
  AddMove(a, c, 0.5);
  std::vector<std::vector<int>> found;
  Budget budget;
  SetFinder(moves_, average_)
      .Find(
          0.1, [&](const std::vector<int>& points) { return found.push_back(points), true; },
          budget);
  ASSERT_FALSE(found.empty());
  std::sort(found[0].begin(), found[0].end());
  EXPECT_THAT(found[0], ElementsAre(a, b, c));

  SubtourSets sets(moves_);
  ASSERT_TRUE(sets.Add(found[0], average_, 0.1));
  EXPECT_FALSE(sets.Add({c, b, a}, average_, 0.1)) << "it is known";
  sets.Step(2);
  Penalties penalties;
  std::vector<double> paid_back;
  EXPECT_EQ(sets.Weigh(penalties, paid_back), 0);

  // 1.5 moves where 1.5 visits less the 0.5 of one are allowed: 0.5 too many, times 2.
  EXPECT_EQ(std::count(penalties.moves.begin(), penalties.moves.end(), 1.0), 3);
  EXPECT_EQ(std::count(paid_back.begin(), paid_back.end(), 1.0), 2);
}

TEST_F(SubtourSetsTest, SetsWithoutMultipliersAreLetGo) {
  AddMove(0, moves_.first(1), 1);
  SubtourSets sets(moves_);
  ASSERT_TRUE(sets.Add({0, moves_.first(1)}, average_, 0.1));

  for (int call = 0; call < 10; ++call) sets.DropIdle();

  EXPECT_EQ(sets.size(), 0u);
  EXPECT_TRUE(sets.Add({0, moves_.first(1)}, average_, 0.1)) << "it is new again";
  sets.Step(1);
  sets.Keep();
  for (int call = 0; call < 10; ++call) sets.DropIdle();
  EXPECT_EQ(sets.size(), 1u);
}

}  // namespace
}  // namespace traverse
