// What follows a path without filament: client/gcode/verify/rules/path_ends.

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

// A line of infill that goes on for 0.04 mm without filament.
std::string Tailed(const std::string& from, const std::string& to, const std::string& on) {
  return absl::StrCat(Line("Internal infill", from, to), "G1 ", on, "\n");
}

TEST(VerifyPathEnds, StayWithTheirPaths) {
  const std::string two =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X0 Y5", "X9 Y5", "X9.04 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + With(two, "G1 X9.04 Y0\n", "")), "path_ends");
  EXPECT_EQ(Broken(kHead + two, kHead + With(two, "G1 X9.04 Y0\n", "G1 X9.2 Y0\n")), "path_ends");
}

TEST(VerifyPathEnds, TurnWithTheirPaths) {
  const std::string two =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X0 Y5", "X9 Y5", "X9.04 Y5");
  const std::string turned =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X9 Y5", "X0 Y5", "X-.04 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + turned), "");
}

}  // namespace
}  // namespace traverse::gcode
