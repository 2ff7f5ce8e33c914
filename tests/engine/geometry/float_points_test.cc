#include "engine/geometry/float_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"

namespace traverse {
namespace {

float Squared(FloatPoint a, FloatPoint b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

TEST(FloatGroups, AreFilledUpWithTheirLastPoint) {
  FloatGroups groups;
  groups.Add({1, 2});
  groups.Close();
  for (const float x : {3.0f, 4.0f, 5.0f, 6.0f, 7.0f}) groups.Add({x, 0});
  groups.Close();

  ASSERT_EQ(groups.size(), 2u);
  ASSERT_EQ(groups.of(0).n, 4u);
  EXPECT_EQ(groups.of(0).y[3], 2);
  ASSERT_EQ(groups.of(1).n, 8u);
  EXPECT_EQ(groups.of(1).x[4], 7);
  EXPECT_EQ(groups.of(1).x[7], 7);
}

TEST(FloatGroups, NearestPointsAreThoseOfTryingAll) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const auto random = [&rng] {
      return FloatPoint{static_cast<float>(rng.Unit()), static_cast<float>(rng.Unit())};
    };
    FloatGroups groups;
    for (int g = 0; g < 2; ++g) {
      for (int i = rng.Between(1, 40); i > 0; --i) groups.Add(random());
      groups.Close();
    }
    const FloatGroups::Group a = groups.of(0);
    const FloatGroups::Group b = groups.of(1);
    const auto at = [](const FloatGroups::Group& g, size_t i) {
      return FloatPoint{g.x[i], g.y[i]};
    };
    const FloatPoint from = random();
    float nearest = std::numeric_limits<float>::infinity();
    float pair = nearest;
    for (size_t j = 0; j < b.n; ++j) {
      nearest = std::min(nearest, Squared(from, at(b, j)));
      for (size_t i = 0; i < a.n; ++i) pair = std::min(pair, Squared(at(a, i), at(b, j)));
    }

    EXPECT_FLOAT_EQ(Squared(from, at(b, NearestOf(b, from))), nearest);
    const NearestPair found = NearestBetween(a, b);
    EXPECT_FLOAT_EQ(found.squared, pair);
    const FloatPoint there = at(b, found.there);
    EXPECT_FLOAT_EQ(Squared(there, at(a, NearestOf(a, there))), pair);
  }
}

}  // namespace
}  // namespace traverse
