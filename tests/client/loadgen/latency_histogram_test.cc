#include "client/loadgen/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace traverse::loadgen {
namespace {

TEST(LatencyHistogram, EmptyIsZero) {
  const LatencyHistogram histogram;

  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.Percentile(0.5), absl::ZeroDuration());
  EXPECT_EQ(histogram.mean(), absl::ZeroDuration());
}

TEST(LatencyHistogram, SmallValuesAreExact) {
  LatencyHistogram histogram;
  for (int ns = 0; ns < 256; ++ns) histogram.Record(absl::Nanoseconds(ns));

  EXPECT_EQ(histogram.Percentile(0), absl::Nanoseconds(0));
  EXPECT_EQ(histogram.Percentile(0.5), absl::Nanoseconds(127));
  EXPECT_EQ(histogram.Percentile(1), absl::Nanoseconds(255));
}

TEST(LatencyHistogram, PercentilesAreTheNearestRanks) {
  LatencyHistogram histogram;
  for (int ns = 1; ns <= 100; ++ns) histogram.Record(absl::Nanoseconds(ns));

  EXPECT_EQ(histogram.Percentile(0.5), absl::Nanoseconds(50));
  EXPECT_EQ(histogram.Percentile(0.501), absl::Nanoseconds(51));
  EXPECT_EQ(histogram.Percentile(0.9), absl::Nanoseconds(90));
  EXPECT_EQ(histogram.Percentile(0.99), absl::Nanoseconds(99));
  EXPECT_EQ(histogram.Percentile(0.999), absl::Nanoseconds(100));
}

TEST(LatencyHistogram, OneValueIsEveryPercentile) {
  LatencyHistogram histogram;
  histogram.Record(absl::Microseconds(1234));

  for (const double share : {0.0, 0.5, 0.999, 1.0}) {
    EXPECT_EQ(histogram.Percentile(share), absl::Microseconds(1234)) << share;
  }
  EXPECT_EQ(histogram.mean(), absl::Microseconds(1234));
  EXPECT_EQ(histogram.max(), absl::Microseconds(1234));
}

TEST(LatencyHistogram, PercentilesAreWithinAPercentOfTheTrueOnes) {
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::lognormal_distribution<double> values(
        std::uniform_real_distribution<double>(5, 20)(random), 2);
    LatencyHistogram histogram;
    std::vector<double> all;
    for (int i = 0; i < 5000; ++i) {
      all.push_back(std::floor(values(random)));
      histogram.Record(absl::Nanoseconds(all.back()));
    }
    std::sort(all.begin(), all.end());

    for (const double share : {0.01, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const double found = absl::ToDoubleNanoseconds(histogram.Percentile(share));
      const double exact = all[static_cast<size_t>(std::ceil(share * 5000)) - 1];
      EXPECT_GE(found, exact) << "seed " << seed << ", share " << share;
      EXPECT_LE(found, exact * 1.008 + 1) << "seed " << seed << ", share " << share;
    }
  }
}

}  // namespace
}  // namespace traverse::loadgen
