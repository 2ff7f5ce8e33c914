// Commands between and within paths: client/gcode/verify/rules/commands.

#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

TEST(VerifyCommands, DoNotComeIntoAPath) {
  const std::string flip = With(kZigzag, "G1 X20 Y11", "M204 P900\nM204 P800\nG1 X20 Y11");
  const std::string a = kHead + "M204 P800\n" + kZigzag;
  EXPECT_EQ(Broken(a, kHead + "M204 P800\n" + flip), "commands");
  const std::string has = With(kZigzag, "G1 X20 Y11", "M117 half\nG1 X20 Y11");
  EXPECT_EQ(Broken(kHead + has, kHead + has), "");
}

TEST(VerifyCommands, AreNotInVain) {
  const std::string a = kHead + "M204 P800\n" + kZigzag + kSquare;
  const std::string vain = With(a, kSquare, "M204 P900\nM204 P800\n" + kSquare);
  EXPECT_EQ(Broken(a, vain), "commands");
  // With a move between it is not; here it is the travel's own.
  const std::string travel = With(a, kSquare, "M204 P900\nM204 P800\n" + kSquare);
  EXPECT_EQ(Broken(travel, travel), "");
}

}  // namespace
}  // namespace traverse::gcode
