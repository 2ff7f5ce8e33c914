// Retractions, lifts and wipes that hidden travel may lack: client/gcode/verify/match/hidden_links.

#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/support/stack.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

VerifyPermissions Hiding(double longest_mm = 30) {
  VerifyPermissions permissions;
  permissions.hidden_retractions = true;
  permissions.max_hidden_travel_mm = longest_mm;
  return permissions;
}

// Boxes of 20 mm, the fourth layer of 30 mm, the fifth and last one with a hole.
std::string Print() {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6}) stack.Layer(z).Box(0, 0, 20).Box(40, 0, 20);
  stack.Layer(0.8).Box(0, 0, 30).Box(40, 0, 20);
  stack.Layer(1).Box(0, 0, 30).Box(40, 0, 20).Wall(46, 6, 8);
  return stack.Text();
}

// `text` with the `n`-th travel of its kind open, from 1.
std::string Opened(std::string text, double x, double y, int n) {
  const std::string retracted = Stack::Retracted(x, y);
  size_t at = text.find(retracted);
  for (; n > 1 && at != std::string::npos; --n) at = text.find(retracted, at + 1);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, retracted.size(), Stack::Open(x, y));
}

// All rules.
std::string BrokenRules(const std::string& a, const std::string& b, VerifyPermissions allowed) {
  return Broken(a, b, allowed, ~0u);
}

TEST(HiddenTravel, NeedsNoRetractionIfThatIsAllowed) {
  const std::string print = Print();
  for (const int layer : {2, 3}) {
    // From the first line to the second one: 16 mm back and 6 mm up.
    const std::string open = Opened(print, 2, 10, layer);
    EXPECT_EQ(BrokenRules(print, open, Hiding()), "") << layer;
    EXPECT_EQ(BrokenRules(print, open, VerifyPermissions{Policy::kFast}), "");
    EXPECT_EQ(BrokenRules(print, open, Hiding(30)), "");
    EXPECT_NE(BrokenRules(print, open, Hiding(17)), "");
    EXPECT_NE(BrokenRules(print, open, Hiding(0)), "");
    EXPECT_NE(BrokenRules(print, open, VerifyPermissions{Policy::kFree}), "");
    EXPECT_NE(BrokenRules(print, open, VerifyPermissions{}), "");
  }
  EXPECT_EQ(BrokenRules(print, Opened(print, 2, 4, 2), Hiding()), "");  // leaves its wall
}

TEST(HiddenTravel, WhatIsSeenStillRetracts) {
  const std::string print = Print();
  EXPECT_NE(BrokenRules(print, Opened(print, 2, 10, 1), Hiding()), "");   // first layer
  EXPECT_NE(BrokenRules(print, Opened(print, 40, 0, 2), Hiding()), "");   // to another part
  EXPECT_NE(BrokenRules(print, Opened(print, 2, 15, 1), Hiding()), "");   // over nothing
  EXPECT_NE(BrokenRules(print, Opened(print, 42, 10, 4), Hiding()), "");  // under a hole
  EXPECT_NE(BrokenRules(print, Opened(print, 42, 10, 5), Hiding()), "");  // last layer
}

TEST(HiddenTravel, GoesStraightAndLevelOrRetracts) {
  const std::string print = Print();
  const std::string open = Opened(print, 2, 10, 2);
  const std::string straight = Stack::Open(2, 10);
  const size_t at = open.find(straight, open.find(straight) + 1);
  const auto by = [&](const std::string& lines) {
    return std::string(open).replace(at, straight.size(), lines);
  };
  EXPECT_EQ(BrokenRules(print, by(straight), Hiding()), "");
  EXPECT_NE(BrokenRules(print, by("G1 X10 Y-5 F9000\n" + straight), Hiding()), "");
  EXPECT_NE(BrokenRules(print, by("G1 Z.6\n" + straight + "G1 Z.4\n"), Hiding()), "");
  EXPECT_NE(BrokenRules(print, by("G1 X2 Y10 F6000\n"), Hiding()), "");
}

// Travel over what is open to the sky from (18, 10) to (2, 16): in the third layer, around a hole
// that all layers have.
TEST(HiddenTravel, MayBendAroundAWallIfThatIsAllowed) {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6, 0.8}) stack.Layer(z).Wall(8, 11, 4).Box(0, 0, 20);
  const std::string print = stack.Text();
  const std::string open = Opened(print, 2, 16, 2);
  const std::string straight = Stack::Open(2, 16);
  const size_t at = open.find(straight, open.find(straight) + 1);
  const auto by = [&](const std::string& lines) {
    return std::string(open).replace(at, straight.size(), lines);
  };
  VerifyPermissions bends;
  bends.inner_detours = true;
  const std::string around = "G1 X12.6 Y15.6 F9000\nG1 X2 Y16\n";
  EXPECT_EQ(BrokenRules(print, by(around), bends), "");
  EXPECT_EQ(BrokenRules(print, by(around), VerifyPermissions{Policy::kFast}), "");
  EXPECT_NE(BrokenRules(print, by(around), Hiding()), "");
  EXPECT_NE(BrokenRules(print, by(straight), bends), "");
  // Too near to the hole, outside, and longer than allowed.
  EXPECT_NE(BrokenRules(print, by("G1 X12.1 Y15.1 F9000\nG1 X2 Y16\n"), bends), "");
  EXPECT_NE(BrokenRules(print, by("G1 X12.6 Y20.6 F9000\nG1 X2 Y16\n"), bends), "");
  bends.max_hidden_travel_mm = 17.5;
  EXPECT_NE(BrokenRules(print, by(around), bends), "");
  // Where the straight move is hidden, nothing is to be led around.
  bends.max_hidden_travel_mm = 30;
  const std::string first = Stack::Open(2, 10);
  const std::string second = Opened(print, 2, 10, 2);
  const size_t begin = second.find(first, second.find(first) + 1);
  const std::string winding = "G1 X10 Y6 F9000\nG1 X2 Y10\n";
  EXPECT_EQ(BrokenRules(print, second, bends), "");
  EXPECT_NE(BrokenRules(print, std::string(second).replace(begin, first.size(), winding), bends),
            "");
}

// The straight move from (18, 10) to (2, 10) leads past a hole, 0.3 mm beside the middle of its
// wall: whoever measures otherwise may lead around it.
TEST(HiddenTravel, MayBendWhereTheStraightMoveIsNotClearlyHidden) {
  VerifyPermissions bends;
  bends.inner_detours = true;
  const auto broken = [&bends](double beside_mm) {
    Stack stack;
    for (const double z : {0.2, 0.4, 0.6})
      stack.Layer(z).Wall(11, 6.625 + beside_mm, 1).Box(0, 0, 20);
    const std::string open = Opened(stack.Text(), 2, 10, 2);
    const std::string straight = Stack::Open(2, 10);
    const size_t at = open.find(straight, open.find(straight) + 1);
    const std::string around = "G1 X11 Y6.3 F9000\nG1 X2 Y10\n";
    return BrokenRules(stack.Text(), std::string(open).replace(at, straight.size(), around), bends);
  };

  EXPECT_EQ(broken(.3), "");
  EXPECT_NE(broken(.7), "");
}

// Slicers go on along some paths, as fast as on other travel, before they leave them.
TEST(HiddenTravel, MayFirstGoOnAlongThePath) {
  const std::string print = Print();
  const std::string retracted = Stack::Retracted(2, 10);
  const auto by = [&](const std::string& lines) {
    const size_t at = print.find(retracted, print.find(retracted) + 1);
    return std::string(print).replace(at, retracted.size(), lines);
  };
  const std::string along = "G1 X17.5 Y4 F9000\n";
  EXPECT_EQ(BrokenRules(by(along + retracted), by(along + Stack::Open(2, 10)), Hiding()), "");
  const std::string aside = "G1 X17.5 Y4.3 F9000\n";
  EXPECT_NE(BrokenRules(by(along + retracted), by(aside + Stack::Open(2, 10)), Hiding()), "");
}

// An inner wall that overhangs over more than half of its length is still no wall that is seen.
TEST(HiddenTravel, PassesAnInnerWallThatOverhangsInPart) {
  const auto print = [](const std::string& begins_as) {
    Stack stack;
    for (const double z : {0.2, 0.4, 0.6}) {
      stack.Layer(z).Wall(0, 0, 20);
      stack.Add(Stack::Open(.45, .45) + "G1 E.8 F2100\n;TYPE:" + begins_as +
                "\nG1 F1200\nG1 X19.55 Y.45 E.714\n;TYPE:Overhang perimeter\nG1 X19.55 Y19.55 "
                "E.714\nG1 X.45 Y19.55 E.714\nG1 X.45 Y.45 E.714\nG1 E-.8 F2100\n");
      stack.Line(2, 4, 16).Line(2, 10, 16);
    }
    return stack.Text();
  };
  const std::string inner = print("Perimeter");
  const std::string outer = print("External perimeter");

  EXPECT_EQ(BrokenRules(inner, Opened(inner, 2, 10, 2), Hiding()), "");
  EXPECT_NE(BrokenRules(outer, Opened(outer, 2, 10, 2), Hiding()), "");
}

TEST(HiddenTravel, IsReadFromTheLineAtTheHead) {
  const std::string print = Print();
  const std::string open = Opened(print, 2, 10, 2);
  const std::string head = "; optimised by Traverse 1.0, policy ";
  EXPECT_EQ(FirstMessage(print, head + "fast: x\n" + open), "");
  EXPECT_EQ(FirstMessage(print, head + "safe, allow wipes+hidden_retractions: x\n" + open), "");
  EXPECT_EQ(FirstMessage(print, head + "fast, max_hidden_travel 20: x\n" + open), "");
  EXPECT_NE(FirstMessage(print, head + "fast, max_hidden_travel 5: x\n" + open), "");
  EXPECT_NE(FirstMessage(print, head + "fast, max_hidden_travel -5: x\n" + open), "");
  EXPECT_NE(FirstMessage(print, head + "free: x\n" + open), "");
}

}  // namespace
}  // namespace traverse::gcode
