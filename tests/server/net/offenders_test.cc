#include "server/net/offenders.h"

#include <gtest/gtest.h>

namespace traverse {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const Offenders::Clock::time_point kNow{std::chrono::hours(1)};

TEST(Offenders, AreBannedTwiceAsLongEachTime) {
  Offenders offenders;
  auto now = kNow;
  for (const int length : {1, 2, 4, 8, 16, 32, 32}) {
    offenders.NoteFlood("a", /*ban_at_once=*/true, now);
    EXPECT_TRUE(offenders.IsBanned("a", now + seconds(length) - milliseconds(1)));
    EXPECT_FALSE(offenders.IsBanned("a", now + seconds(length)));
    EXPECT_FALSE(offenders.IsBanned("b", now));
    now += seconds(length);
    offenders.Tidy(now);
  }
  offenders.Tidy(now + std::chrono::minutes(3));
  offenders.NoteFlood("a", /*ban_at_once=*/true, now);
  EXPECT_FALSE(offenders.IsBanned("a", now + seconds(1)));
}

TEST(Offenders, AreBannedForTheSecondFloodOfStrangers) {
  Offenders offenders;
  offenders.NoteFlood("a", /*ban_at_once=*/false, kNow);
  EXPECT_FALSE(offenders.IsBanned("a", kNow));
  offenders.NoteFlood("a", /*ban_at_once=*/false, kNow);
  EXPECT_TRUE(offenders.IsBanned("a", kNow));
}

TEST(Offenders, TheBusiestMakesMoreThanHalfOfMuchWork) {
  Offenders offenders;
  offenders.NoteWork("a", Offenders::kMuchWork, kNow);
  EXPECT_EQ(offenders.TakeBusiest(kNow), "");  // not much
  offenders.NoteWork("a", 2, kNow);
  offenders.NoteWork("b", Offenders::kMuchWork + 2, kNow);
  EXPECT_EQ(offenders.TakeBusiest(kNow), "");  // the half
  offenders.NoteWork("a", 1, kNow);
  EXPECT_EQ(offenders.TakeBusiest(kNow), "a");
  EXPECT_EQ(offenders.TakeBusiest(kNow), "b");
  EXPECT_EQ(offenders.TakeBusiest(kNow), "");
}

TEST(Offenders, WorkIsHalvedInEachSecond) {
  Offenders offenders;
  offenders.NoteWork("a", 2 * Offenders::kMuchWork + 1, kNow);
  offenders.Tidy(kNow + seconds(1));
  EXPECT_EQ(offenders.TakeBusiest(kNow + seconds(2)), "");
  EXPECT_EQ(offenders.TakeBusiest(kNow + seconds(1)), "a");
}

}  // namespace
}  // namespace traverse
