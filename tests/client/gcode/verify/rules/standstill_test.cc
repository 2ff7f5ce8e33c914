// Filament pushed without a move: client/gcode/verify/rules/standstill.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

TEST(VerifyStandstill, NoBlobComesInOrMoves) {
  const std::string blob = With(kTwo, Travel("X0 Y5"), "G1 E1 F2100\n" + Travel("X0 Y5"));
  EXPECT_THAT(Broken(kHead + kTwo, kHead + blob), HasSubstr("standstill"));
  EXPECT_THAT(Broken(kHead + blob, kHead + kTwo), HasSubstr("standstill"));
  const std::string moved = With(kTwo, Travel("X0 Y5"), Travel("X0 Y5") + "G1 E1 F2100\n");
  EXPECT_THAT(Broken(kHead + blob, kHead + moved), HasSubstr("standstill"));
  EXPECT_EQ(Broken(kHead + blob, kHead + blob), "");
}

TEST(VerifyStandstill, WhatIsPushedMoreThanPulledIsPushedAsOften) {
  const std::string more = "G1 E-1 F2100\nG1 X0 Y5 F9000\nG1 E1.02 F2100\n";
  const std::string two = Line("Internal infill", "X0 Y0", "X9 Y0") +
                          With(Line("Internal infill", "X0 Y5", "X9 Y5"), Travel("X0 Y5"), more);
  const std::string without = With(two, more, "G1 X0 Y5 F9000\n");
  EXPECT_THAT(Broken(kHead + two, kHead + without), HasSubstr("standstill"));
  // It comes with the travel, wherever that leads.
  const std::string turned = With(With(two, "X0 Y5", "X9 Y5"), "G1 X9 Y5 E.3", "G1 X0 Y5 E.3");
  EXPECT_EQ(Broken(kHead + two, kHead + turned), "");
}

// A label divides the layer, and another order retracts for another path. It does so for no other
// layer, and for no other tool.
TEST(VerifyStandstill, WhatIsPushedMoreThanPulledStaysInItsLayer) {
  const std::string plain = "G1 X0 Y5 F9000\n";
  const std::string more = "G1 E-1 F2100\nG1 X0 Y5 F9000\nG1 E1.02 F2100\n";
  const auto print = [](const std::string& first, const std::string& between,
                        const std::string& second) {
    const std::string line = "G1 X9 Y5 E.3 F1200\nG1 X0 Y0 F9000\nG1 X9 Y0 E.3 F1200\n";
    return absl::StrCat(kHead, ";TYPE:Internal infill\n", first, line, between, second, line);
  };
  constexpr uint32_t kRule = RuleBit(VerifyRule::kStandstill);
  for (const char* between : {"M104 S200\n", "; printing object a\n"}) {
    EXPECT_EQ(Broken(print(more, between, plain), print(plain, between, more), {}, kRule), "");
  }
  for (const char* between : {";LAYER_CHANGE\nG1 Z.4 F9000\n", "T1\n"}) {
    EXPECT_EQ(Broken(print(more, between, plain), print(plain, between, more), {}, kRule),
              "standstill");
  }
}

// Printers begin with tool 0: what a start script pulled back before it says so comes back.
TEST(VerifyStandstill, TheFirstToolIsInForceFromTheBegin) {
  const auto print = [](const std::string& tool, const std::string& first,
                        const std::string& second) {
    const std::string start = "M83\nG92 E0\nG1 X0 Y50 F9000\nG1 X20 E9 F600\nG1 E-1 F2100\n";
    return start + ";LAYER_CHANGE\nG1 Z.2 F9000\n" + tool + With(first, "G1 E-1 F2100\n", "") +
           second;
  };
  const std::string other = Line("Internal infill", "X0 Y5", "X9 Y5");
  const std::string one = Line("Internal infill", "X0 Y0", "X9 Y0");
  constexpr uint32_t kRule = RuleBit(VerifyRule::kStandstill);
  EXPECT_EQ(Broken(print("T0\n", one, other), print("T0\n", other, one), {}, kRule), "");
  EXPECT_EQ(Broken(print("T1\n", one, other), print("T1\n", other, one), {}, kRule), "standstill");
}

TEST(VerifyStandstill, WhatIsPushedLessThanPulledIsPushedAsOften) {
  const std::string less = "G1 E-1 F2100\nG1 X0 Y5 F9000\nG1 E.98 F2100\n";
  const std::string two = Line("Internal infill", "X0 Y0", "X9 Y0") +
                          With(Line("Internal infill", "X0 Y5", "X9 Y5"), Travel("X0 Y5"), less);
  const std::string without = With(two, less, "G1 X0 Y5 F9000\n");
  EXPECT_THAT(Broken(kHead + two, kHead + without), HasSubstr("standstill"));
  const std::string whole = With(two, "E.98 ", "E1 ");
  EXPECT_THAT(Broken(kHead + two, kHead + whole), HasSubstr("standstill"));
  EXPECT_THAT(Broken(kHead + whole, kHead + two), HasSubstr("standstill"));
  EXPECT_EQ(Broken(kHead + two, kHead + two), "");
}

TEST(VerifyStandstill, WhatRoundingLeavesIsNothing) {
  const std::string more = With(kTwo, Travel("X0 Y5"), With(Travel("X0 Y5"), "E1 ", "E1.0009 "));
  EXPECT_EQ(Broken(kHead + more, kHead + kOneTurned), "");
  const std::string little = With(kTwo, "G1 X9 Y5", "G1 E.00001\nG1 X9 Y5");
  EXPECT_EQ(Broken(kHead + little, kHead + kOneTurned), "");
}

}  // namespace
}  // namespace traverse::gcode
