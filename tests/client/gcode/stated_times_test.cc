// Print times that G-code states, restated.

#include "client/gcode/stated_times.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace traverse::gcode {
namespace {

constexpr TimeScale kScale = {0.9, 0.5};

TEST(RestateTimes, ChangesWhatSlicersState) {
  const std::pair<const char*, const char*> cases[] = {
      {"; estimated printing time (normal mode) = 3m 41s",
       "; estimated printing time (normal mode) = 3m 19s"},
      {"; estimated printing time (silent mode) = 1d 0h 0m 24s",
       "; estimated printing time (silent mode) = 21h 36m 22s"},
      {"; estimated first layer printing time (normal mode) = 1m 23s",
       "; estimated first layer printing time (normal mode) = 42s"},
      // Seven minutes and a half of heating stay.
      {"; model printing time: 1m 40s; total estimated time: 9m 10s",
       "; model printing time: 1m 30s; total estimated time: 9m 0s"},
      {";TIME:5360", ";TIME:4824"},
      {";TIME_ELAPSED:9.236161", ";TIME_ELAPSED:8.312545"},
      {";PRINTING_TIME: 41", ";PRINTING_TIME: 37"},
      {";REMAINING_TIME: 704\r", ";REMAINING_TIME: 634\r"},
      {"M73 P0 R124", "M73 P0 R112"},
      {"M73 Q50 S10 C3 ; R9", "M73 Q50 S9 C3 ; R9"},
      {"M73 P100 R0", "M73 P100 R0"},
      {"M117 Time Left 1h0m10s", "M117 Time Left 54m9s"},
      {"M117 33% left 1h 0m 10s, layer 3/20", "M117 33% left 54m 9s, layer 3/20"},
      {"M118 elapsed 01:00:10", "M118 elapsed 00:54:09"},
      {"M117 remaining 2:00", "M117 remaining 1:48"},
      {"SET_DISPLAY_TEXT MSG=\"10m left\"", "SET_DISPLAY_TEXT MSG=\"9m0s left\""},
  };
  for (const auto& [line, restated] : cases) {
    EXPECT_EQ(RestateTimes(line, kScale), restated);
    EXPECT_EQ(RestateTimes(std::string(line) + "\n", kScale), std::string(restated) + "\n");
  }
}

TEST(RestateTimes, LeavesAllElse) {
  const std::string text =
      ";TIME:soon\n; model printing time: long\nM73.2   R1.0 ;Reset\nM104 S220 ; wait time\n"
      "; estimated printing time (normal mode)\n;TIMELAPSE\nG1 X1 R2\nM73 L5\n\n; = \n;";
  EXPECT_EQ(RestateTimes(text, kScale), text);
}

TEST(RestateTimes, ChangesNothingByOne) {
  const std::string text =
      "; estimated printing time (normal mode) = 1h 0m 24s\nM73 P0 R60\n;TIME:12.50\n";
  EXPECT_EQ(RestateTimes(text, {1, 1}), text);
}

TEST(StatedScale, IsReadFromTheLineThatSaysIt) {
  const TimeScale scale = RoundScale({0.97341234567, 1.0 / 3});
  const std::string line =
      "; optimised by Traverse 0.1.0, policy safe: travel; " + DescribeScale(scale);

  const auto stated = StatedScale("; head\n" + line + "\nG28\n");

  ASSERT_TRUE(stated);
  EXPECT_EQ(stated->total, scale.total);
  EXPECT_EQ(stated->first_layer, scale.first_layer);
  EXPECT_FALSE(StatedScale("; optimised by Traverse 0.1.0, policy safe\nG28\n"));
  EXPECT_FALSE(StatedScale("G28\n; times restated x0.5\n"));
}

// Some slicers end lines with two returns.
TEST(RestateOptimised, SaysItWithinTheLineWhateverEndsThat) {
  const std::string line = "; optimised by Traverse 0.1.0, policy safe";
  for (const std::string end : {"\n", "\r\n", "\r\r\n"}) {
    EXPECT_EQ(RestateOptimised(line + end + "G28" + end, kScale),
              line + ", " + DescribeScale(kScale) + end + "G28" + end);
  }
}

}  // namespace
}  // namespace traverse::gcode
