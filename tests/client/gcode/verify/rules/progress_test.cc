// M73 lines: client/gcode/verify/rules/progress.

#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

TEST(VerifyProgress, KeepsItsSequence) {
  const std::string a = kHead + "M73 P1\n" + kSquare + "M73 P2\n" + kZigzag;
  EXPECT_EQ(
      Broken(a, With(With(With(a, "M73 P1", "M73 P3"), "M73 P2", "M73 P1"), "M73 P3", "M73 P2")),
      "progress");
  EXPECT_EQ(Broken(a, kHead + "M73 P1\nM73 P2\n" + kSquare + kZigzag), "");
}

}  // namespace
}  // namespace traverse::gcode
