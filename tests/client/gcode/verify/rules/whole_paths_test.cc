// Paths are printed whole: client/gcode/verify/rules/whole_paths.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

TEST(VerifyWholePaths, APathIsNotCut) {
  const std::string cut = Way("X10 Y10") + ";TYPE:Internal infill\nG1 F1800\nG1 X20 Y10 E.3\n" +
                          Way("X10 Y11") + "G1 F1800\nG1 X20 Y11 E.3\nG1 X20 Y10 E.1\n";
  EXPECT_EQ(Broken(kHead + kZigzag, kHead + cut), "whole_paths");
}

TEST(VerifyWholePaths, APathMayBeTurnedAndALoopBegunElsewhere) {
  const std::string turned = Way("X10 Y11") +
                             ";TYPE:Internal infill\nG1 F1800\nG1 X20 Y11 E.3\nG1 X20 Y10 E.1\n"
                             "G1 X10 Y10 E.3\n";
  EXPECT_EQ(Broken(kHead + kZigzag, kHead + turned), "");

  const std::string inner = With(kSquare, "External perimeter", "Perimeter");
  const std::string gap = With(inner, "G1 X10 Y10 E.4", "G1 X10 Y10.06 E.4");
  const std::string elsewhere = Way("X20 Y10") +
                                ";TYPE:Perimeter\nG1 F1200\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\n"
                                "G1 X10 Y10.06 E.4\nG1 X10 Y10\nG1 X20 Y10 E.4\n";
  EXPECT_EQ(Broken(kHead + gap, kHead + elsewhere), "");
}

TEST(VerifyWholePaths, ASecondCutOfALoopIsNone) {
  const std::string inner = With(kSquare, "External perimeter", "Perimeter");
  const std::string twice = Way("X20 Y10") + ";TYPE:Perimeter\nG1 F1200\nG1 X20 Y20 E.4\n" +
                            Way("X10 Y20") + "G1 F1200\nG1 X10 Y10 E.4\nG1 X20 Y10 E.4\n" +
                            Way("X20 Y20") + "G1 F1200\nG1 X10 Y20 E.4\n";
  EXPECT_THAT(Broken(kHead + inner, kHead + twice), HasSubstr("whole_paths"));
}

// Three loops in one place, one of them begun elsewhere, are printed in one go: what is left of a
// loop comes first.
TEST(VerifyWholePaths, LoopsOfOnePlaceAreToldApart) {
  const std::string infill = ";TYPE:Internal infill\nG1 F1800\n";
  const std::string left = "G1 X10 Y10 E.4\n";
  const std::string up = "G1 X10 Y20 E.4\n";
  const std::string right = "G1 X20 Y20 E.4\n";
  const std::string short_down = "G1 X20 Y10.07 E.397\n";
  const std::string one = infill + left + up + right + short_down;
  const std::string a = kHead + Way("X20 Y10") + one + Way("X20 Y10") + one + Way("X10 Y20") +
                        infill + right + "G1 X20 Y10 E.4\n" + left + "G1 X10 Y19.93 E.397\n";
  const std::string turned = up + right + short_down + "G1 X20 Y10\n" + left;
  const std::string b = kHead + Way("X10 Y10") + infill + turned +
                        "G1 X10 Y19.93 E.397\nG1 X10 Y20\n" + right + "G1 X20 Y10 E.4\n" + left +
                        turned;
  EXPECT_EQ(Broken(a, b, Policy::kFree), "");
}

}  // namespace
}  // namespace traverse::gcode
