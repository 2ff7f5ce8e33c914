#include "client/loadgen/load_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/status_matchers.h"

namespace traverse::loadgen {
namespace {

TEST(ParseMix, SizesAndWeights) {
  ASSERT_OK_AND_ASSIGN(const std::vector<SizeShare> mix, ParseMix("1:70,10:2.5,400"));

  ASSERT_EQ(mix.size(), 3u);
  EXPECT_EQ(mix[0].layers, 1);
  EXPECT_EQ(mix[0].weight, 70);
  EXPECT_EQ(mix[1].weight, 2.5);
  EXPECT_EQ(mix[2].layers, 400);
  EXPECT_EQ(mix[2].weight, 1);
}

TEST(ParseMix, FaultsAreNamed) {
  for (const char* text :
       {"", "0", "-1", "x", "1:", "1:0", "1:-2", "1:nan", "1:2:3", "1,,2", "1:inf"}) {
    EXPECT_FALSE(ParseMix(text).ok()) << text;
  }
}

TEST(SizeChoice, FollowsTheWeightsAndTheSeed) {
  const std::vector<SizeShare> mix = {{1, 70}, {10, 25}, {400, 5}};
  SizeChoice choice(mix, 1);
  SizeChoice again(mix, 1);
  std::vector<int> count(3);
  for (int i = 0; i < 100'000; ++i) {
    const size_t kind = choice.Next();
    ASSERT_EQ(kind, again.Next());
    ++count[kind];
  }

  EXPECT_NEAR(count[0], 70'000, 1000);
  EXPECT_NEAR(count[1], 25'000, 1000);
  EXPECT_NEAR(count[2], 5'000, 500);
}

TEST(SendTimes, EvenOnesAreEquallyFarApart) {
  const auto times = SendTimes(100, absl::Seconds(2), Arrivals::kEven, 1);

  ASSERT_EQ(times.size(), 200u);
  for (size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(absl::ToDoubleSeconds(times[i]), 0.01 * static_cast<double>(i), 1e-8);
  }
}

TEST(SendTimes, PoissonGapsAreAsLongAsTheirSpread) {
  const auto times = SendTimes(1000, absl::Seconds(50), Arrivals::kPoisson, 3);
  double sum = 0, squares = 0;
  for (size_t i = 1; i < times.size(); ++i) {
    const double gap = absl::ToDoubleSeconds(times[i] - times[i - 1]);
    ASSERT_GE(gap, 0);
    sum += gap;
    squares += gap * gap;
  }
  const double n = static_cast<double>(times.size() - 1);
  const double mean = sum / n;

  EXPECT_NEAR(mean, 1e-3, 5e-5);
  EXPECT_NEAR(std::sqrt(squares / n - mean * mean), mean, 0.05 * mean);
  EXPECT_EQ(times, SendTimes(1000, absl::Seconds(50), Arrivals::kPoisson, 3));
}

}  // namespace
}  // namespace traverse::loadgen
