#include "server/jobs/return_lag.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace traverse {
namespace {

using std::chrono::milliseconds;

TEST(ReturnLag, KnowsNothingAtFirst) {
  EXPECT_EQ(ReturnLag().Margin("a"), ReturnLag::Duration::zero());
}

TEST(ReturnLag, RisesAtOnceAndFadesSlowly) {
  ReturnLag lag;
  lag.Record("a", milliseconds(20));
  EXPECT_EQ(lag.Margin("a"), milliseconds(30));

  lag.Record("a", milliseconds(0));
  EXPECT_EQ(lag.Margin("a"), milliseconds(27));
  for (int call = 0; call < 100; ++call) lag.Record("a", milliseconds(0));
  EXPECT_LT(lag.Margin("a"), milliseconds(1));
}

TEST(ReturnLag, OfOneCallerIsNothingToAnother) {
  ReturnLag lag;
  for (int call = 0; call < 7; ++call) lag.Record("slow", std::chrono::seconds(10));

  EXPECT_EQ(lag.Margin("quick"), ReturnLag::Duration::zero());
}

TEST(ReturnLag, CallersWithoutNumberTakeNoMemoryWithoutEnd) {
  ReturnLag lag;
  for (int i = 0; i < 10'000; ++i) lag.Record(std::to_string(i), milliseconds(20));

  EXPECT_EQ(lag.Margin("9999"), milliseconds(30));
  EXPECT_EQ(lag.Margin("0"), ReturnLag::Duration::zero());
}

TEST(WakeLateness, LeavesTwiceTheLatenessOfLate) {
  WakeLateness lateness;
  WakeLateness::Clock::time_point now{std::chrono::seconds(1)};
  const auto tick = [&](milliseconds late) { lateness.Tick(now += WakeLateness::kPeriod + late); };
  tick(milliseconds(0));
  EXPECT_EQ(lateness.Margin(), WakeLateness::Duration::zero());

  tick(milliseconds(30));
  EXPECT_EQ(lateness.Margin(), milliseconds(60));
  tick(milliseconds(0));
  EXPECT_GT(lateness.Margin(), milliseconds(59));
  for (int i = 0; i < 2000; ++i) tick(milliseconds(0));
  EXPECT_LT(lateness.Margin(), milliseconds(1));
}

}  // namespace
}  // namespace traverse
