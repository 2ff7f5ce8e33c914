#include "server/jobs/return_margin.h"

#include <gtest/gtest.h>

namespace traverse {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(MarginOfReturn, IsATenthOfTheTimeWithinBounds) {
  EXPECT_EQ(MarginOfReturn({.left = seconds(2)}), milliseconds(200));
  EXPECT_EQ(MarginOfReturn({.left = milliseconds(60)}), milliseconds(10));
  EXPECT_EQ(MarginOfReturn({.left = seconds(60)}), milliseconds(500));
}

TEST(MarginOfReturn, GrowsWithLayersAndPoints) {
  EXPECT_EQ(MarginOfReturn({.left = seconds(2), .layers = 1000}), milliseconds(300));
  EXPECT_EQ(MarginOfReturn({.left = seconds(2), .points = 200'000}), milliseconds(300));
}

TEST(MarginOfReturn, LeavesWhatTheCallersLastAnswersTook) {
  EXPECT_EQ(MarginOfReturn({.left = seconds(2), .lag = milliseconds(150)}), milliseconds(200));
  EXPECT_EQ(MarginOfReturn({.left = seconds(2), .lag = milliseconds(350)}), milliseconds(350));
}

TEST(MarginOfReturn, AddsWhatThreadsWaitForABusyMachine) {
  EXPECT_EQ(MarginOfReturn({.left = seconds(2), .wakings = milliseconds(40)}), milliseconds(240));
}

TEST(MarginOfReturn, LeavesHalfOfTheTimeToTheSearch) {
  EXPECT_EQ(MarginOfReturn({.left = seconds(2), .points = 100'000'000}), seconds(1));
  EXPECT_EQ(MarginOfReturn({.left = milliseconds(10)}), milliseconds(5));
}

}  // namespace
}  // namespace traverse
