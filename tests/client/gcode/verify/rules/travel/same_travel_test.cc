// Travel moves between the same two points as in the original:
// client/gcode/verify/rules/travel/same_travel.

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

// Nothing lies between the paths, and another travel of the layer is open and as long.
TEST(VerifySameTravels, ARetractionStaysWithItsTravel) {
  const std::string third = Line("Internal infill", "X0 Y10", "X9 Y10");
  const std::string open = "G1 X0 Y10 F9000\n";
  const std::string a = kTwo + With(third, Travel("X0 Y10"), open);
  const std::string moved =
      With(With(a, Travel("X0 Y5"), "G1 X0 Y5 F9000\n"), open, Travel("X0 Y10"));
  EXPECT_EQ(Broken(kHead + a, kHead + moved, Policy::kFree), "open_travel");
  // A travel move from there to another point may be open.
  const std::string turned =
      With(With(a, Travel("X0 Y5"), "G1 X9 Y5 F9000\n"), "G1 X9 Y5 E.3", "G1 X0 Y5 E.3");
  EXPECT_EQ(Broken(kHead + a, kHead + turned, Policy::kFree), "");
}

// One travel in three is lifted: nothing is to be learnt of travel moves as such.
std::string ThreeTravels(const std::string& lifted) {
  return absl::StrCat(kHead, kTwo, Lifted("X0 Y10"),
                      ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y10 E.3\n", lifted,
                      ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y20 E.3\n",
                      Line("Internal infill", "X0 Y30", "X9 Y30"));
}

TEST(VerifySameTravels, ALiftStaysWithItsTravel) {
  const std::string travel = Lifted("X0 Y20");
  const std::string a = ThreeTravels(travel);
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, ThreeTravels(Travel("X0 Y20")), Policy::kFree), "lifts");
  const std::string half = With(travel, "Z.6", "Z.4");
  EXPECT_EQ(Broken(a, ThreeTravels(half), Policy::kFree), "lifts");
  EXPECT_NE(FirstMessage(a, ThreeTravels(half)).find("lifted by 0.400 mm in the original"),
            std::string::npos);
  // A travel move from there to another point may be low.
  const std::string turned = With(ThreeTravels(Travel("X9 Y20")), "G1 X9 Y20 E.3", "G1 X0 Y20 E.3");
  EXPECT_EQ(Broken(a, turned, Policy::kFree), "");
}

// The layer has both speeds: which way goes at which does not change.
TEST(VerifySameTravels, SpeedsStayWithTheirTravels) {
  const auto line = [](const char* y, const char* speeds) {
    return absl::StrCat("G1 X0 Y", y, speeds, "G1 X9 Y", y, " E.3\n");
  };
  const std::string slow = " F6000\n;TYPE:Internal infill\nG1 F1800\n";
  const std::string fast = " F9000\n;TYPE:Internal infill\nG1 F1800\n";
  const auto print = [&](const std::string& a, const std::string& b, const std::string& c) {
    return kHead + line("0", fast.c_str()) + line("3", a.c_str()) + line("6", b.c_str()) +
           line("9", c.c_str());
  };
  EXPECT_EQ(Broken(print(slow, fast, slow), print(slow, fast, slow)), "");
  EXPECT_EQ(Broken(print(slow, fast, slow), print(slow, slow, slow)), "speeds");
  // Another travel may go at either speed.
  const std::string a = print(slow, fast, slow);
  EXPECT_EQ(Broken(a, kHead + line("0", fast.c_str()) + line("6", slow.c_str()) +
                          line("3", fast.c_str()) + line("9", fast.c_str())),
            "");
  const std::string quick = With(a, "G1 X0 Y6", "M204 T500\nG1 X0 Y6");
  EXPECT_EQ(Broken(quick, With(quick, "M204 T500\n", "")), "speeds");
}

// Of the travel moves that are not retracted too few are lifted to tell anything of others.
TEST(VerifySameTravels, LiftsOfOpenTravelsStayWithThem) {
  const std::string lifted = "G1 Z.6 F9000\nG1 X0 Y6 F9000\nG1 Z.2\n";
  const auto line = [](const std::string& travel, const char* y) {
    return absl::StrCat(travel, ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y", y, " E.3\n");
  };
  const std::string a = kHead + line("G1 X0 Y0 F9000\n", "0") + line("G1 X0 Y3 F9000\n", "3") +
                        line(lifted, "6") + line("G1 X0 Y9 F9000\n", "9");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, lifted, "G1 X0 Y6 F9000\n")), "lifts");
}

}  // namespace
}  // namespace traverse::gcode
