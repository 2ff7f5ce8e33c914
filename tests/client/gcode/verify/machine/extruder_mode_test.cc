#include "client/gcode/verify/machine/extruder_mode.h"

#include <gtest/gtest.h>

namespace traverse::gcode {
namespace {

TEST(ExtruderMode, CountsFromTheMoveBeforeWhereWordsFallAsTheyRise) {
  EXPECT_TRUE(CountsFromTheMoveBefore("G1 X1 E.5\nG1 X2 E.4\nG1 X3 E.5\nG1 X4 E.3\n"));
  EXPECT_TRUE(CountsFromTheMoveBefore("g1 x1 e.5\ng1 x2 e.4\n"));
  EXPECT_FALSE(CountsFromTheMoveBefore("G1 X1 E.5\nG1 X2 E.9\nG92 E0\nG1 X3 E.4\nG1 X4 E.7\n"));
  EXPECT_FALSE(CountsFromTheMoveBefore("G1 X1 E.5\nG1 E-1\nG1 E0\nG1 X2 E.9\n"));
}

TEST(ExtruderMode, IsAsAnyLineSays) {
  EXPECT_FALSE(CountsFromTheMoveBefore("G1 X1 E.5\nG1 X2 E.4\n M82\n"));
  EXPECT_FALSE(CountsFromTheMoveBefore("G1 X1 E.5\nG1 X2 E.4\nm83\n"));
  EXPECT_TRUE(CountsFromTheMoveBefore("G1 X1 E.5\nG1 X2 E.4 ; no M82\n"));
}

}  // namespace
}  // namespace traverse::gcode
