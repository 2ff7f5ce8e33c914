// Where outer walls begin: client/gcode/verify/rules/seam.

#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

TEST(VerifySeam, OfAnOuterWallIsTheSamePointOrUnderBalancedASharpCorner) {
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareElsewhere), "seam");
  const std::string flat = With(kSquare, "G1 X20 Y10 E.4", "G1 X15 Y10 E.2\nG1 X20 Y10 E.2");
  const std::string in_the_middle = Travel("X15 Y10") + kWall +
                                    "G1 X20 Y10 E.2\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\n"
                                    "G1 X10 Y10 E.4\nG1 X15 Y10 E.2\n";
  EXPECT_EQ(Broken(kHead + flat, kHead + in_the_middle, Policy::kBalanced), "seam");
}

TEST(VerifySeam, MayMoveToACornerUnderBalancedAndAnywhereOnInnerWalls) {
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareElsewhere, Policy::kBalanced), "");
  const auto inner = [](const std::string& square) {
    return With(square, "External perimeter", "Perimeter");
  };
  EXPECT_EQ(Broken(kHead + inner(kSquare), kHead + inner(kSquareElsewhere)), "");
}

TEST(VerifySeam, MovesNotEvenByAShortSegmentUnderSafe) {
  const std::string fine = With(kSquare, "G1 X20 Y10 E.4", "G1 X10.04 Y10 E.01\nG1 X20 Y10 E.4");
  const std::string moved = Travel("X10.04 Y10") + kWall +
                            "G1 X20 Y10 E.4\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\nG1 X10 Y10 E.4\n"
                            "G1 X10.04 Y10 E.01\n";
  EXPECT_EQ(Broken(kHead + fine, kHead + moved), "seam");
  EXPECT_EQ(Broken(kHead + fine, kHead + moved, Policy::kBalanced), "");
}

}  // namespace
}  // namespace traverse::gcode
