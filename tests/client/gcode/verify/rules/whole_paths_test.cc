// Paths are printed whole: client/gcode/verify/rules/whole_paths.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

TEST(VerifyWholePaths, APathIsNotCut) {
  const std::string cut = Travel("X10 Y10") + ";TYPE:Internal infill\nG1 F1800\nG1 X20 Y10 E.3\n" +
                          Travel("X10 Y11") + "G1 F1800\nG1 X20 Y11 E.3\nG1 X20 Y10 E.1\n";
  EXPECT_EQ(Broken(kHead + kZigzag, kHead + cut), "whole_paths");
}

TEST(VerifyWholePaths, APathMayBeTurnedAndALoopBegunElsewhere) {
  const std::string turned = Travel("X10 Y11") +
                             ";TYPE:Internal infill\nG1 F1800\nG1 X20 Y11 E.3\nG1 X20 Y10 E.1\n"
                             "G1 X10 Y10 E.3\n";
  EXPECT_EQ(Broken(kHead + kZigzag, kHead + turned), "");

  const std::string inner = With(kSquare, "External perimeter", "Perimeter");
  const std::string gap = With(inner, "G1 X10 Y10 E.4", "G1 X10 Y10.06 E.4");
  const std::string elsewhere = Travel("X20 Y10") +
                                ";TYPE:Perimeter\nG1 F1200\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\n"
                                "G1 X10 Y10.06 E.4\nG1 X10 Y10\nG1 X20 Y10 E.4\n";
  EXPECT_EQ(Broken(kHead + gap, kHead + elsewhere), "");
}

// A square of inner wall that ends 0.1 mm short of its start, and the same begun at its second
// corner with that gap before it.
const std::string kClipped = Travel("X10 Y10") +
                             ";TYPE:Perimeter\nG1 F1200\nG1 X20 Y10 E.4\nG1 X20 Y20 E.4\n"
                             "G1 X10 Y20 E.4\nG1 X10 Y10.1 E.396\n";
const std::string kGapMoved = Travel("X20 Y10") +
                              ";TYPE:Perimeter\nG1 F1200\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\n"
                              "G1 X10 Y10.1 E.396\nG1 X10 Y10 E.004\nG1 X19.9 Y10 E.396\n";

std::string WithGap(const std::string& from, const std::string& to) {
  return kHead + With(kGapMoved, from, to);
}

TEST(VerifyWholePaths, ALoopMayTakeItsGapAlong) {
  const std::string next = Line("Internal infill", "X12 Y15", "X18 Y15");

  EXPECT_EQ(Broken(kHead + kClipped + next, kHead + next + kGapMoved), "");
  EXPECT_EQ(Broken(kHead + kClipped + kClipped, kHead + kGapMoved + kClipped), "");
  // An outer one no more than it may begin elsewhere.
  const std::string outer = With(kClipped, "Perimeter", "External perimeter");
  const std::string moved = With(kGapMoved, "Perimeter", "External perimeter");
  EXPECT_EQ(Broken(kHead + outer, kHead + moved), "seam");
  EXPECT_EQ(Broken(kHead + outer, kHead + moved, Policy::kFree), "");
}

TEST(VerifyWholePaths, AMovedGapHasTheSameLengthAndFilament) {
  const std::string a = kHead + kClipped;
  for (const auto& [b, what] : std::vector<std::pair<std::string, std::string>>{
           // More filament than before, and less.
           {WithGap("E.004", "E.0042"), "0.00420 mm of filament close the gap of this loop, and "},
           {WithGap("X19.9 Y10 E.396", "X19.9 Y10 E.394"), "and its end has 0.00600 mm less"},
           // As much, but not on this length.
           {With(WithGap("E.004", "E.006"), "X19.9 Y10 E.396", "X19.9 Y10 E.394"),
            "where its other segments would have 0.00400 mm"},
           {WithGap("X19.9", "X19.95"), "ends 0.050 mm from its start"},
           {WithGap("X19.9", "X20"), "ends 0.000 mm from its start"},
           {WithGap("X19.9 Y10 ", "X19.9 Y10.03 "), "0.030 mm beside its last segment"}}) {
    EXPECT_EQ(Broken(a, b), "same_print");
    EXPECT_THAT(FirstMessage(a, b), HasSubstr(what));
  }
}

// Its last segment may be what closes the gap.
const std::string kClosedOnward = With(kGapMoved, "Y10.1 E.396\nG1 X10 Y10 E.004\n", "Y10 E.4\n");

TEST(VerifyWholePaths, TheLastSegmentOfALoopMayCloseItsGap) {
  const std::string next = Line("Internal infill", "X12 Y15", "X18 Y15");
  const std::string a = kHead + kClipped;

  EXPECT_EQ(Broken(kHead + kClipped + next, kHead + next + kClosedOnward), "");
  EXPECT_EQ(Broken(kHead + kClipped + kClipped, kHead + kClosedOnward + kGapMoved), "");
  const std::string outer = With(kClipped, "Perimeter", "External perimeter");
  const std::string moved = With(kClosedOnward, "Perimeter", "External perimeter");
  EXPECT_EQ(Broken(kHead + outer, kHead + moved), "seam");

  const auto other = [](const std::string& from, const std::string& to) {
    return kHead + With(kClosedOnward, from, to);
  };
  for (const auto& [b, what] : std::vector<std::pair<std::string, std::string>>{
           {other("X10 Y10 E.4", "X10 Y10 E.4002"), "0.00420 mm of filament close the gap"},
           {other("X19.9 Y10 E.396", "X20 Y10 E.4"), "do not print `G1 X10 Y10 E.4`"},
           {other("X19.9 Y10 E.396", "X19.9 Y10 E.394"), "and its end has 0.00600 mm less"}}) {
    EXPECT_EQ(Broken(a, b), "same_print");
    EXPECT_THAT(FirstMessage(a, b), HasSubstr(what));
  }
  for (const std::string& b :
       {other("X10 Y10 E.4", "X10 Y10 E.4 F1800"), other("X10 Y10 E.4", "X10.01 Y10 E.4"),
        other("G1 X10 Y20 E.4\nG1 X10 Y10 E.4", "G1 X10 Y10 E.8")}) {
    EXPECT_EQ(Broken(a, b), "same_print") << b;
  }
  // It leaves out no bend.
  const std::string bent = With(kClipped, "X10 Y10.1 E.396", "X10.006 Y10.1 E.396");
  EXPECT_THAT(FirstMessage(kHead + bent, kHead + kClosedOnward), HasSubstr("a bend of 0.0"));
}

// A loop begun with its last side, which closes the gap.
TEST(VerifyWholePaths, TheLastSegmentOfALoopMayCloseItsGapWhereTheLoopBeginsWithIt) {
  const std::string next = Line("Internal infill", "X12 Y15", "X18 Y15");
  const std::string moved = Travel("X10 Y20") +
                            ";TYPE:Perimeter\nG1 F1200\nG1 X10 Y10 E.4\nG1 X20 Y10 E.4\n"
                            "G1 X20 Y20 E.4\nG1 X10.1 Y20 E.396\n";

  EXPECT_EQ(Broken(kHead + kClipped + next, kHead + next + moved), "");
  EXPECT_EQ(Broken(kHead + kClipped + kClipped, kHead + moved + kGapMoved), "");
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"X10 Y10 E.4", "X10 Y10 E.4002"},
                                                        {"X10 Y10 E.4", "X10.01 Y10 E.4"},
                                                        {"X10.1 Y20 E.396", "X10 Y20 E.4"},
                                                        {"X20 Y10 E.4", "X20 Y10 E.41"}}) {
    EXPECT_EQ(Broken(kHead + kClipped, kHead + With(moved, from, to)), "same_print") << to;
  }
}

// IceSL prints the same loop again and again, begun at one corner or another: what the original has
// too is none that was moved.
TEST(VerifyWholePaths, ALoopUponAnotherIsNotTakenForThatOneMoved) {
  const std::string upon = With(kClosedOnward, "X10 Y10 E.4", "X10 Y10 E.40003");
  EXPECT_EQ(Broken(kHead + upon + kClipped, kHead + upon + kClosedOnward), "");
  EXPECT_EQ(Broken(kHead + upon + kClipped, kHead + upon + kGapMoved), "");
  EXPECT_THAT(Broken(kHead + upon + kClipped, kHead + upon + upon), HasSubstr("same_print"));
}

// Of three loops in one place the second begins where the others do not, and now where they did;
// the third begins where the second did. Rounding tells them apart.
TEST(VerifyWholePaths, LoopsOfOnePlaceMayChangeTheirStarts) {
  const auto square = [](const std::string& to, const std::string& sides) {
    return Travel(to) + ";TYPE:Perimeter\nG1 F1200\n" + sides;
  };
  const std::string other =
      square("X20 Y10", "G1 X20 Y20 E.4\nG1 X10 Y20 E.4\nG1 X10 Y10 E.4\nG1 X19.9 Y10 E.3961\n");
  const std::string elsewhere =
      square("X20 Y20", "G1 X10 Y20 E.4\nG1 X10 Y10 E.4\nG1 X20 Y10 E.4\nG1 X20 Y19.9 E.396\n");
  const std::string moved = square(
      "X10 Y10", "G1 X20 Y10 E.40011\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\nG1 X10 Y10.1 E.39599\n");
  const std::string a = kHead + kClipped + other + kClipped;

  EXPECT_EQ(Broken(a, kHead + elsewhere + moved + kClosedOnward), "");
  EXPECT_NE(Broken(a, kHead + elsewhere + moved + moved), "");
}

// The last path of the file has one segment of a loop with 200: no other one can be looked at
// there.
TEST(VerifyWholePaths, APieceOfALoopIsNotThatLoopMoved) {
  std::string loop = Travel("X0 Y0") + ";TYPE:Perimeter\nG1 F1200\n";
  for (int i = 1; i <= 99; ++i) loop += absl::StrCat("G1 X", i, " Y", 10 * (i % 2), " E.4\n");
  for (int i = 100; i <= 199; ++i) loop += absl::StrCat("G1 X", 198 - i, " Y30 E.4\n");
  loop += "G1 X0 Y.1 E.4\n";
  const std::string piece = Travel("X1 Y10") + ";TYPE:Perimeter\nG1 F1200\nG1 X2 Y0 E.4\n";
  std::string pieces;
  for (int i = 0; i < 210; ++i) pieces += piece;
  EXPECT_THAT(Broken(kHead + loop, kHead + pieces), HasSubstr("same_print"));
}

TEST(VerifyWholePaths, AMovedGapIsClosedInOneAndTheSameLoop) {
  const std::string a = kHead + kClipped;
  for (const std::string& b :
       {// At another speed, under another name, by an arc, beside the gap, and not at all.
        WithGap("G1 X10 Y10 E.004", "G1 X10 Y10 E.004 F1800"),
        WithGap("G1 X10 Y10 E.004", ";TYPE:Internal infill\nG1 X10 Y10 E.004\n;TYPE:Perimeter"),
        WithGap("G1 X10 Y10 E.004", "G2 X10 Y10 I0 J-.05 E.004"),
        WithGap("G1 X10 Y10 E.004", "G1 X10.01 Y10 E.004"),
        WithGap("G1 X10 Y10 E.004", "G1 X10 Y10"),
        // Its end at another speed.
        WithGap("G1 X19.9", "G1 F1300\nG1 X19.9"),
        // A travel move on the way.
        WithGap("G1 X10 Y10 E.004\n", "G1 X10 Y10 E.004\nG1 X11 Y10\nG1 X10 Y10\n"),
        // Closed, and not opened.
        kHead + With(kClipped, "Y10.1 E.396\n", "Y10.1 E.396\nG1 X10 Y10 E.004\n")}) {
    EXPECT_EQ(Broken(a, b), "same_print") << b;
  }
  // A loop without a gap does not get one.
  const std::string closed = With(kClipped, "Y10.1 E.396", "Y10 E.4");
  EXPECT_EQ(Broken(kHead + closed, kHead + kClosedOnward), "same_print");
}

TEST(VerifyWholePaths, TheDepositThatDiffersIsNotThatOfAMovedGap) {
  const std::string infill = Line("Internal infill", "X12 Y15", "X18 Y15");
  EXPECT_THAT(FirstMessage(kHead + kClipped + infill,
                           kHead + kGapMoved + With(infill, "X18 Y15", "X17 Y15")),
              HasSubstr("`G1 X17 Y15 E.3`"));
}

TEST(VerifyWholePaths, ASecondCutOfALoopIsNone) {
  const std::string inner = With(kSquare, "External perimeter", "Perimeter");
  const std::string twice = Travel("X20 Y10") + ";TYPE:Perimeter\nG1 F1200\nG1 X20 Y20 E.4\n" +
                            Travel("X10 Y20") + "G1 F1200\nG1 X10 Y10 E.4\nG1 X20 Y10 E.4\n" +
                            Travel("X20 Y20") + "G1 F1200\nG1 X10 Y20 E.4\n";
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
  const std::string a = kHead + Travel("X20 Y10") + one + Travel("X20 Y10") + one +
                        Travel("X10 Y20") + infill + right + "G1 X20 Y10 E.4\n" + left +
                        "G1 X10 Y19.93 E.397\n";
  const std::string turned = up + right + short_down + "G1 X20 Y10\n" + left;
  const std::string b = kHead + Travel("X10 Y10") + infill + turned +
                        "G1 X10 Y19.93 E.397\nG1 X10 Y20\n" + right + "G1 X20 Y10 E.4\n" + left +
                        turned;
  EXPECT_EQ(Broken(a, b, Policy::kFree), "");
}

}  // namespace
}  // namespace traverse::gcode
