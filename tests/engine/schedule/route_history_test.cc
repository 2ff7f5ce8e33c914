#include "engine/schedule/route_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr uint64_t kShape = 7;
constexpr uint64_t kKey = 70;

KnownRoutePtr RouteThatCosts(double cost) {
  auto known = std::make_shared<KnownRoute>();
  known->cost = cost;
  return known;
}

TEST(RouteHistory, TheFirstOfItsShapeHasNothingToStartFrom) {
  RouteHistory history;

  EXPECT_EQ(history.Enter(kShape, kKey, std::make_shared<PendingRoute>()), nullptr);
}

TEST(RouteHistory, CountsTheLayersOfAShape) {
  RouteHistory history;
  for (const uint64_t key : {kKey, kKey + 1, kKey}) {
    history.Enter(kShape, key, std::make_shared<PendingRoute>());
  }

  EXPECT_EQ(history.Seen(kShape), 3);
  EXPECT_EQ(history.Seen(kShape + 1), 0);
}

TEST(RouteHistory, KeepsTheCheaperRouteOfAKey) {
  RouteHistory history;
  const auto first = std::make_shared<PendingRoute>();
  const auto second = std::make_shared<PendingRoute>();
  const auto third = std::make_shared<PendingRoute>();
  for (const auto& entry : {first, second, third}) history.Enter(kShape, kKey, entry);

  RouteHistory::Complete(first, RouteThatCosts(10), false);
  RouteHistory::Complete(second, RouteThatCosts(12), true);
  EXPECT_EQ(second->best->cost, 10);
  EXPECT_EQ(second->idle, 1);

  RouteHistory::Complete(third, RouteThatCosts(9), false);
  EXPECT_EQ(third->best->cost, 9);
  EXPECT_EQ(third->idle, 0);
}

TEST(RouteHistory, ARouteThatCostsTheSameCountsAsTheOldOne) {
  RouteHistory history;
  const auto first = std::make_shared<PendingRoute>();
  const auto second = std::make_shared<PendingRoute>();
  for (const auto& entry : {first, second}) history.Enter(kShape, kKey, entry);
  RouteHistory::Complete(first, RouteThatCosts(10), false);

  RouteHistory::Complete(second, RouteThatCosts(10), true);

  EXPECT_EQ(second->best, first->best);
}

TEST(RouteHistory, WhatWaitsIsReleasedInOrderOnceAllBeforeAreThere) {
  RouteHistory history;
  const auto first = std::make_shared<PendingRoute>();
  const auto second = std::make_shared<PendingRoute>();
  for (const auto& entry : {first, second}) history.Enter(kShape, kKey, entry);
  first->waiting = {4};
  second->waiting = {5, 6};

  EXPECT_THAT(RouteHistory::Complete(second, RouteThatCosts(1), false), IsEmpty());
  EXPECT_FALSE(second->ready);
  EXPECT_THAT(RouteHistory::Complete(first, RouteThatCosts(2), false), ElementsAre(4, 5, 6));
  EXPECT_TRUE(second->ready);
}

TEST(RouteHistory, StartsFromTheRouteSoManyRepetitionsBefore) {
  RouteHistory history;
  std::vector<RouteHistory::Entry> entries;
  for (size_t i = 0; i <= RouteHistory::kLag; ++i) {
    entries.push_back(std::make_shared<PendingRoute>());
    const RouteHistory::Entry model = history.Enter(kShape, kKey, entries.back());
    EXPECT_EQ(model, i > 0 ? entries[0] : nullptr) << i;
  }
  const auto next = std::make_shared<PendingRoute>();

  EXPECT_EQ(history.Enter(kShape, kKey, next), entries[1]);
}

TEST(RouteHistory, ANewKindStartsFromARouteOfItsShape) {
  RouteHistory history;
  const auto first = std::make_shared<PendingRoute>();
  history.Enter(kShape, kKey, first);

  EXPECT_EQ(history.Enter(kShape, kKey + 1, std::make_shared<PendingRoute>()), first);
  EXPECT_EQ(history.Enter(kShape + 1, kKey + 2, std::make_shared<PendingRoute>()), nullptr);
}

TEST(RouteHistory, NothingIsLeftOfAJobThatIsGivenUp) {
  std::weak_ptr<PendingRoute> first, last;
  {
    RouteHistory history;
    std::vector<RouteHistory::Entry> entries;  // of layers that were never solved
    for (int i = 0; i < 1'000'000; ++i) {
      entries.push_back(std::make_shared<PendingRoute>());
      history.Enter(kShape, kKey, entries.back());
    }
    first = entries.front();
    last = entries.back();
  }

  EXPECT_TRUE(first.expired());
  EXPECT_TRUE(last.expired());
}

TEST(RouteHistory, WhatWasLearntTakesNoPlaceOfAKeyThatIsKnown) {
  RouteHistory history;
  const auto first = std::make_shared<PendingRoute>();
  history.Enter(kShape, kKey, first);

  history.Learn(kShape, kKey, RouteThatCosts(1));
  history.Learn(kShape, kKey + 1, RouteThatCosts(2));

  EXPECT_EQ(history.Enter(kShape, kKey, std::make_shared<PendingRoute>()), first);
  const auto learnt = history.Enter(kShape, kKey + 1, std::make_shared<PendingRoute>());
  ASSERT_NE(learnt, nullptr);
  EXPECT_EQ(learnt->best->cost, 2);
}

}  // namespace
}  // namespace traverse
