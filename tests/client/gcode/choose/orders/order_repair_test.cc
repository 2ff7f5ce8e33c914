// Orders without one of their links: client/gcode/choose/orders/order_repair.h.

#include "client/gcode/choose/orders/order_repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "engine/base/rng.h"

namespace traverse::gcode {
namespace {

using ::testing::ElementsAre;

Placement Path(uint32_t block, uint32_t entry = 0) { return {block, entry, false}; }

// The paths from 10 on, as sliced.
LayerOrder Sliced(size_t paths) {
  LayerOrder order;
  for (size_t i = 0; i < paths; ++i) order.push_back(Path(static_cast<uint32_t>(10 + i)));
  return order;
}

LayerOrder Shuffled(size_t paths, Rng& rng) {
  LayerOrder order = Sliced(paths);
  for (uint32_t i = static_cast<uint32_t>(paths) - 1; i > 0; --i) {
    std::swap(order[i], order[rng.Below(i + 1)]);
  }
  return order;
}

TEST(OrdersWithoutLink, EachPathOfTheLinkIsBesideItsOwnNeighbor) {
  const LayerOrder order = {Path(10), Path(13, 1), Path(11), Path(14), Path(12, 1), Path(15)};

  const auto orders = OrdersWithoutLink(order, 2, Sliced(6), 1);

  // 13 with 14, behind 11, which comes before both; 10 with 11; and both ends of the link.
  const LayerOrder with_next = {Path(10), Path(11), Path(13), Path(14), Path(12, 1), Path(15)};
  const LayerOrder with_last = {Path(10), Path(11), Path(13, 1), Path(14), Path(12, 1), Path(15)};
  EXPECT_THAT(orders, ElementsAre(with_next, with_last, with_next));
}

TEST(OrdersWithoutLink, MoreAroundItIsAsSlicedIfItReachesFarther) {
  const LayerOrder order = {Path(10), Path(14, 1), Path(13, 1), Path(12, 1), Path(11, 1), Path(15)};

  EXPECT_EQ(OrdersWithoutLink(order, 2, Sliced(6), 64).back(), Sliced(6));
  EXPECT_EQ(OrdersWithoutLink(order, 1, Sliced(6), 2).back(),
            (LayerOrder{Path(10), Path(13), Path(14), Path(12, 1), Path(11, 1), Path(15)}));
}

// Whether some path comes before another one in `order` as in neither of the others.
bool HasOrderOfItsOwn(const LayerOrder& order, const LayerOrder& before, size_t paths) {
  std::vector<size_t> at(paths);
  for (size_t i = 0; i < paths; ++i) at[before[i].block - 10] = i;
  for (size_t i = 0; i < paths; ++i) {
    for (size_t k = i + 1; k < paths; ++k) {
      const bool as_sliced = order[i].block < order[k].block;
      if (!as_sliced && at[order[i].block - 10] > at[order[k].block - 10]) return true;
    }
  }
  return false;
}

TEST(InOrderOf, PutsTheFirstOfAPairRightBeforeTheSecond) {
  const LayerOrder order = {Path(10), Path(14, 1), Path(15), Path(12), Path(11, 1), Path(13)};

  EXPECT_TRUE(BreaksAnyOf(order, 10, {{0, 1}, {1, 4}}));
  EXPECT_FALSE(BreaksAnyOf(order, 10, {{0, 1}, {1, 3}}));
  // 12 comes before 14 as sliced, and 15 behind it.
  EXPECT_EQ(InOrderOf(order, 10, {{1, 4}}),
            (LayerOrder{Path(10), Path(12), Path(11, 1), Path(14, 1), Path(15), Path(13)}));
  EXPECT_EQ(InOrderOf(order, 10, {{0, 1}}), order);
}

TEST(InOrderOf, ManyPairsAreSliced) {
  constexpr uint32_t kPaths = 300;
  LayerOrder order = Sliced(kPaths);
  std::reverse(order.begin() + 1, order.end() - 1);
  std::vector<PathPair> pairs;
  for (uint32_t path = 1; path + 2 < kPaths; ++path) pairs.emplace_back(path, path + 1);

  EXPECT_FALSE(BreaksAnyOf(InOrderOf(order, 10, pairs), 10, pairs));
}

// Nothing else changes places but towards the order as sliced.
TEST(InOrderOf, OtherPairsStayInTheirOrderOrAreAsSliced) {
  constexpr uint32_t kPaths = 9;
  Rng rng(5);
  for (int round = 0; round < 300; ++round) {
    const LayerOrder order = Shuffled(kPaths, rng);
    const uint32_t first = rng.Below(kPaths - 1);
    const PathPair pair{first, first + 1 + rng.Below(kPaths - 1 - first)};
    const LayerOrder made = InOrderOf(order, 10, {pair});
    EXPECT_FALSE(BreaksAnyOf(made, 10, {pair}));
    EXPECT_FALSE(HasOrderOfItsOwn(made, order, kPaths));
  }
}

TEST(OrdersWithoutLink, PairsStayInTheirOrderOrAreAsSliced) {
  constexpr uint32_t kPaths = 9;
  Rng rng(5);
  for (int round = 0; round < 200; ++round) {
    const LayerOrder order = Shuffled(kPaths, rng);
    const size_t place = 1 + rng.Below(kPaths - 1);
    std::vector<LayerOrder> orders =
        OrdersWithoutLink(order, place, Sliced(kPaths), 1 + rng.Below(4));
    orders.push_back(BegunAsSliced(order, Sliced(kPaths)));
    orders.push_back(EndedAsSliced(order, Sliced(kPaths)));
    for (LayerOrder& other : orders) {
      EXPECT_FALSE(HasOrderOfItsOwn(other, order, kPaths));
      std::sort(other.begin(), other.end(),
                [](const Placement& a, const Placement& b) { return a.block < b.block; });
      EXPECT_EQ(other, Sliced(kPaths));
    }
  }
}

TEST(BegunAsSliced, TheFirstAndTheLastPathMoveThereAlone) {
  const LayerOrder order = {Path(12, 1), Path(10, 1), Path(13), Path(11)};

  EXPECT_EQ(BegunAsSliced(order, Sliced(4)),
            (LayerOrder{Path(10), Path(12, 1), Path(13), Path(11)}));
  EXPECT_EQ(EndedAsSliced(order, Sliced(4)),
            (LayerOrder{Path(12, 1), Path(10, 1), Path(11), Path(13)}));
}

TEST(HasAnyOf, KnowsLinksByBothEnds) {
  const LinkSet links = {{Path(10), Path(12, 1)}};

  EXPECT_TRUE(HasAnyOf({Path(11), Path(10), Path(12, 1)}, links));
  EXPECT_FALSE(HasAnyOf({Path(11), Path(10), Path(12)}, links));
  EXPECT_FALSE(HasAnyOf({Path(12, 1), Path(10)}, links));
}

}  // namespace
}  // namespace traverse::gcode
