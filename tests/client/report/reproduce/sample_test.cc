// Samples and how many are needed: client/report/reproduce/sample.

#include "client/report/reproduce/sample.h"

#include <gtest/gtest.h>

namespace traverse::report {
namespace {

// The first column of thesis table 3.2, and what equation 3.2 makes of it there.
TEST(SampleSize, IsThatOfThesisTable32) {
  const Sample sample =
      SampleOf({543.98, 611.47, 593.42, 559.15, 559.82, 551.18, 555.14, 547.58, 541.46, 575.58});

  EXPECT_EQ(sample.size, 10);
  EXPECT_NEAR(sample.mean, 563.88, 0.005);
  EXPECT_NEAR(sample.deviation, 22.89, 0.005);
  EXPECT_NEAR(SamplesNeeded(sample), 3.37, 0.005);
  EXPECT_EQ(SamplesNeeded({1, 5, 0}), 0);
}

}  // namespace
}  // namespace traverse::report
