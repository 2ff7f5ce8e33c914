#include "server/return_lag.h"

#include <gtest/gtest.h>

#include <chrono>

namespace traverse {
namespace {

using std::chrono::milliseconds;

TEST(ReturnLag, NothingIsKnownAtFirst) { EXPECT_EQ(ReturnLag().Margin(), milliseconds(0)); }

TEST(ReturnLag, RisesAtOnceAndFallsSlowly) {
  ReturnLag lag;
  lag.Record(milliseconds(100));
  EXPECT_EQ(lag.Margin(), milliseconds(150));

  lag.Record(milliseconds(0));
  EXPECT_EQ(lag.Margin(), milliseconds(135));
  for (int i = 0; i < 100; ++i) lag.Record(milliseconds(0));
  EXPECT_LT(lag.Margin(), milliseconds(1));
}

}  // namespace
}  // namespace traverse
