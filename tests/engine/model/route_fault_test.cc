#include "engine/model/route_fault.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using Kind = RouteFault::Kind;
using namespace traverse::testing;  // NOLINT

Route WithGivenEntries(const Plan& plan, const std::vector<int>& order) {
  Route route;
  for (const int p : order) route.push_back({p, GivenEntry(plan.paths[static_cast<size_t>(p)])});
  return route;
}

bool Begins(const std::vector<int>& order, const std::vector<int>& as, size_t length) {
  return std::equal(order.begin(), order.begin() + static_cast<ptrdiff_t>(length), as.begin());
}

size_t PositionOf(int path, const std::vector<int>& order) {
  return static_cast<size_t>(std::find(order.begin(), order.end(), path) - order.begin());
}

TEST(RouteFault, IsTheFirstVisitAfterWhichNoRouteGoesOn) {
  for (uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = RandomPlan(seed, {.max_paths = 5});
    const std::vector<std::vector<int>> legal = LegalOrders(plan);
    std::vector<int> order;
    for (int p = 0; p < static_cast<int>(plan.paths.size()); ++p) order.push_back(p);

    do {
      size_t longest = 0;
      for (const std::vector<int>& known : legal) {
        while (longest < order.size() && Begins(known, order, longest + 1)) ++longest;
      }
      const std::optional<RouteFault> fault = FindRouteFault(plan, WithGivenEntries(plan, order));
      ASSERT_EQ(fault.has_value(), longest < order.size());
      if (!fault) continue;
      EXPECT_EQ(fault->kind, Kind::kTooEarly);
      EXPECT_EQ(fault->visit, longest);
      for (const std::vector<int>& known : legal) {
        if (!Begins(known, order, longest)) continue;
        EXPECT_LT(PositionOf(fault->other, known), PositionOf(order[longest], known));
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

// Anything that a caller may send, beside a legal route.
Route Damaged(Route route, Rng& rng) {
  const auto at = [&] {
    return static_cast<size_t>(rng.Between(0, static_cast<int>(route.size()) - 1));
  };
  for (int damage = static_cast<int>(rng.Below(3)); damage > 0 && !route.empty(); --damage) {
    switch (rng.Below(6)) {
      case 0:
        std::swap(route[at()], route[at()]);
        break;
      case 1:
        route.erase(route.begin() + static_cast<ptrdiff_t>(at()));
        break;
      case 2:
        route.push_back(route[at()]);
        break;
      case 3:
        route[at()].path += static_cast<int>(rng.Below(5)) - 2;
        break;
      case 4:
        route[at()].entry += static_cast<int>(rng.Below(5)) - 2;
        break;
      default:
        route[at()].entry = static_cast<int>(rng.Below(3));
    }
  }
  return route;
}

TEST(RouteFault, IsFoundExactlyWhereTheValidatorRefuses) {
  int refused = 0;
  for (uint64_t seed = 1; seed <= 3000; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = RandomPlan(seed, {.max_paths = 30});
    Rng rng(seed);
    const Route route = Damaged(GivenRoute(plan), rng);

    const std::optional<RouteFault> fault = FindRouteFault(plan, route);

    ASSERT_EQ(!fault.has_value(), ValidateRoute(plan, route).ok());
    refused += fault ? 1 : 0;
    EXPECT_LE(fault ? fault->visit : 0, route.size());
  }
  EXPECT_GT(refused, 500);
  EXPECT_LT(refused, 2500);
}

TEST(RouteFault, NamesWhatIsWrong) {
  const Plan plan =
      AnyOrderPlan({MakeContour({{0, 0}, {1, 0}, {2, 0}}, {2}), MakeOpenPath({0, 0}, {1, 1}, true),
                    MakeOpenPath({0, 0}, {1, 1})});
  const struct {
    Route route;
    Kind kind;
    size_t visit;
    int other;
  } cases[] = {
      {{{0, 2}, {3, 0}}, Kind::kNoPath, 1, 0},
      {{{-1, 0}}, Kind::kNoPath, 0, 0},
      {{{0, 2}, {2, 1}, {0, 2}}, Kind::kRepeated, 2, 0},
      {{{0, 1}}, Kind::kEntry, 0, 0},
      {{{0, 3}}, Kind::kEntry, 0, 0},
      {{{0, 2}, {1, 1}}, Kind::kEntry, 1, 0},
      {{{0, 2}, {2, 2}}, Kind::kEntry, 1, 0},
      {{{2, 1}, {0, 2}}, Kind::kMissing, 2, 1},
      {{}, Kind::kMissing, 0, 0},
  };
  for (const auto& bad : cases) {
    const std::optional<RouteFault> fault = FindRouteFault(plan, bad.route);
    ASSERT_TRUE(fault.has_value());
    EXPECT_EQ(fault->kind, bad.kind);
    EXPECT_EQ(fault->visit, bad.visit);
    EXPECT_EQ(fault->other, bad.other);
  }
  EXPECT_FALSE(FindRouteFault(plan, {{0, 2}, {2, 1}, {1, 0}}));
}

TEST(RouteFault, KeepsPairsThroughAChildWithoutPaths) {
  Plan plan = FlatPlan(2);
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
  plan.nodes[0].children.push_back(3);
  plan.nodes[0].before = {{1, 2}, {2, 0}};

  EXPECT_FALSE(FindRouteFault(plan, {{1, 0}, {0, 0}}));
  const std::optional<RouteFault> fault = FindRouteFault(plan, {{0, 0}, {1, 0}});
  ASSERT_TRUE(fault.has_value());
  EXPECT_EQ(fault->kind, Kind::kTooEarly);
  EXPECT_EQ(fault->other, 1);
}

}  // namespace
}  // namespace traverse
