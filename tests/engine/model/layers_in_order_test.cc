#include "engine/model/layers_in_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/validator.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::RandomPlan;

TEST(LayersInOrder, ArePlansWhoseRoutesAreThoseOfEachLayerInItsTurn) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const std::vector<Plan> plans = {RandomPlan(seed), RandomPlan(seed + 1000),
                                     RandomPlan(seed + 2000)};
    const std::vector<Route> given = {GivenRoute(plans[0]), GivenRoute(plans[1]),
                                      GivenRoute(plans[2])};
    for (size_t layers = 1; layers <= plans.size(); ++layers) {
      std::vector<const Plan*> some;
      std::vector<const Route*> routes;
      for (size_t i = 0; i < layers; ++i) {
        some.push_back(&plans[i]);
        routes.push_back(&given[i]);
      }

      const Plan all = PlanInOrder(some);
      const Route route = RouteInOrder(routes);

      EXPECT_TRUE(CheckPlan(all).ok()) << CheckPlan(all);
      EXPECT_TRUE(ValidateRoute(all, route).ok()) << ValidateRoute(all, route);
      EXPECT_EQ(route, GivenRoute(all));
      EXPECT_EQ(RoutesOfEach(some, route),
                std::vector<Route>(given.begin(), given.begin() + static_cast<long>(layers)));
    }
  }
}

TEST(LayersInOrder, DoNotLetALaterLayerBegin) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan first = RandomPlan(seed);
    const Plan second = RandomPlan(seed + 1000);
    if (first.paths.empty() || second.paths.empty()) continue;
    const Route first_route = GivenRoute(first);
    const Route second_route = GivenRoute(second);
    const std::vector<const Plan*> plans = {&first, &second};
    const std::vector<const Route*> routes = {&first_route, &second_route};
    Route route = RouteInOrder(routes);

    std::rotate(route.begin(), route.begin() + static_cast<long>(first_route.size()), route.end());

    EXPECT_FALSE(ValidateRoute(PlanInOrder(plans), route).ok());
  }
}

}  // namespace
}  // namespace traverse
