// Lifts of travel: client/gcode/verify/rules/lifts.

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "client/gcode/verify/verifier.h"

namespace traverse::gcode {
namespace {

// Lines of infill with retracted ways to them, each lifted but for that to line `low`.
std::string Lines(int count, int low) {
  std::string text = "M83\n;LAYER_CHANGE\nG1 Z.2 F9000\n";
  for (int i = 0; i < count; ++i) {
    const std::string to = absl::StrCat("G1 X", 10 * (i % 2), " Y", i, " F9000\n");
    absl::StrAppend(
        &text, "G1 E-1 F2100\n", i == low ? to : absl::StrCat("G1 Z.6 F9000\n", to, "G1 Z.2\n"),
        "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X", 10 - 10 * (i % 2), " Y", i, " E.3\n");
  }
  return text;
}

int64_t LiftsBroken(const std::string& original, const std::string& optimised) {
  const VerifyReport report = CheckGcode(original, "a", optimised, "b", VerifyOptions());
  return static_cast<int64_t>(report.counts[static_cast<size_t>(VerifyRule::kLifts)]);
}

TEST(VerifyLifts, WhatTheFileLeavesLowMayStayLow) {
  EXPECT_EQ(LiftsBroken(Lines(150, 70), Lines(150, 70)), 0);
  EXPECT_EQ(LiftsBroken(Lines(150, 70), Lines(150, -1)), 0);
  // Another one may not, though the file has one.
  EXPECT_EQ(LiftsBroken(Lines(150, 70), Lines(150, 40)), 1);
  EXPECT_EQ(LiftsBroken(Lines(150, -1), Lines(150, 40)), 1);
}

}  // namespace
}  // namespace traverse::gcode
