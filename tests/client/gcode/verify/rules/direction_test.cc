// Which way round paths are printed: client/gcode/verify/rules/direction.

#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

TEST(VerifyDirection, OfOuterLoopsAndOpenWallsIsAsSliced) {
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareTurned), "direction");
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareTurned, Policy::kBalanced), "direction");
  const std::string open = Line("Perimeter", "X1 Y0", "X9 Y0");
  EXPECT_EQ(Broken(kHead + open, kHead + Line("Perimeter", "X9 Y0", "X1 Y0")), "direction");
}

TEST(VerifyDirection, IsFreeForInfillAndUnderFree) {
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareTurned, Policy::kFree), "");
  const std::string open = Line("Internal infill", "X1 Y0", "X9 Y0");
  EXPECT_EQ(Broken(kHead + open, kHead + Line("Internal infill", "X9 Y0", "X1 Y0")), "");
}

TEST(VerifyDirection, OfMonotonicSurfacesIsAsSliced) {
  const auto line = [](const char* type, const char* from, const char* to) {
    return kHead + Line(type, from, to);
  };
  for (const char* type : {"Top solid infill", "Ironing"}) {
    const std::string a = line(type, "X1 Y1", "X9 Y1");
    const std::string b = line(type, "X9 Y1", "X1 Y1");
    EXPECT_EQ(Broken(a, b, Policy::kBalanced), "direction") << type;
    const bool irons = std::string(type) == "Ironing";
    EXPECT_EQ(Broken(a, b, Policy::kFree), irons ? "direction" : "") << type;
  }
  const std::string a = line("Top solid infill", "X1 Y1", "X9 Y1");
  const std::string b = line("Top solid infill", "X9 Y1", "X1 Y1");
  const std::string settings = "; top_fill_pattern = rectilinear\n";
  EXPECT_EQ(Broken(a + settings, b + settings), "");
}

}  // namespace
}  // namespace traverse::gcode
