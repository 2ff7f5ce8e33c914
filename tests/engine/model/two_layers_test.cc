#include "engine/model/two_layers.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "engine/validator.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::RandomPlan;

TEST(TwoLayers, ArePlansWhoseRoutesAreThoseOfTheFirstAndThenOfTheSecond) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan first = RandomPlan(seed);
    const Plan second = RandomPlan(seed + 1000);
    const int paths = static_cast<int>(first.paths.size());

    const Plan both = PlanOfBoth(first, second);
    const Route route = RouteOfBoth(GivenRoute(first), GivenRoute(second), paths);

    EXPECT_TRUE(CheckPlan(both).ok()) << CheckPlan(both);
    EXPECT_TRUE(ValidateRoute(both, route).ok()) << ValidateRoute(both, route);
    EXPECT_EQ(route, GivenRoute(both));
    EXPECT_EQ(RouteOfFirst(route, paths), GivenRoute(first));
    EXPECT_EQ(RouteOfSecond(route, paths), GivenRoute(second));
    if (first.paths.empty() || second.paths.empty()) continue;
    const Route swapped = RouteOfBoth(GivenRoute(second), GivenRoute(first), 0);
    EXPECT_FALSE(ValidateRoute(both, swapped).ok());
  }
}

}  // namespace
}  // namespace traverse
