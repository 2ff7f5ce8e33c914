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

}  // namespace
}  // namespace traverse::gcode
