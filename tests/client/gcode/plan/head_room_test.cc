// What stands in the way of new travel: client/gcode/plan/head_room.h.

#include "client/gcode/plan/head_room.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/gcode/measure/layer_meter.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/support/sanitizers.h"

namespace traverse::gcode {
namespace {

using testing::Read;

std::string LayerAt(double z) { return absl::StrFormat(";LAYER_CHANGE\nG1 Z%.2f F9000\n", z); }

std::string LineAt(double x, double from_y, double to_y) {
  return absl::StrCat("G1 X", x, " Y", from_y, " F9000\n;TYPE:Internal infill\nG1 F1800\nG1 Y",
                      to_y, " E.3\n");
}

std::string Square(double low, double high) {
  return absl::StrCat("G1 X", low, " Y", low, " F9000\n;TYPE:External perimeter\nG1 F1200\nG1 X",
                      high, " E.4\nG1 Y", high, " E.4\nG1 X", low, " E.4\nG1 Y", low, " E.4\n");
}

// A tower of 4 mm between X20 and X26, and two layers of lines on either side of it.
std::string BesideATower() {
  std::string print = "M83\n";
  for (int layer = 1; layer <= 20; ++layer) {
    absl::StrAppend(&print, LayerAt(0.2 * layer), Square(20, 26));
  }
  absl::StrAppend(&print, "G1 Z6 F9000\nG1 X10 Y20\n");
  for (const double z : {.2, .4}) {
    absl::StrAppend(&print, LayerAt(z), LineAt(10, 20, 26), "G1 X10 Y50\nG1 X36 Y50\n",
                    LineAt(36, 26, 20));
    absl::StrAppend(&print, "G1 Z5 F9000\nG1 X10 Y22\nG1 Z", z, "\n", LineAt(12, 22, 24));
  }
  return print;
}

// The most memory that the process used, in KiB.
int64_t PeakKb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    int64_t kb = 0;
    if (word == "VmHWM:" && status >> kb) return kb;
  }
  return 0;
}

TEST(HeadRoom, NothingIsInTheTravelWhereTheHeightOnlyGoesUp) {
  const auto file = Read("M83\n" + LayerAt(.2) + Square(20, 26) + LayerAt(.4) + Square(20, 26));

  const HeadRoom room(*file);

  EXPECT_EQ(room.Of(0), nullptr);
  EXPECT_EQ(room.Of(1), nullptr);
}

TEST(HeadRoom, WhatIsFinishedStandsInTheTravelOfWhatIsLower) {
  const auto file = Read(BesideATower());
  const HeadRoom room(*file);
  EXPECT_EQ(room.Of(0), nullptr);
  ASSERT_EQ(file->layers.size(), 22u);
  const Room* beside = room.Of(20);
  ASSERT_NE(beside, nullptr);
  EXPECT_EQ(room.Of(21), beside);

  const auto clear = [&](Point a, Point b, double z) { return beside->IsClear(a, z, b, z); };
  // Through it, above it, and where the file leads.
  EXPECT_FALSE(clear({10, 23}, {36, 23}, .2));
  EXPECT_FALSE(clear({10, 23}, {36, 23}, 3.8));
  EXPECT_TRUE(clear({10, 23}, {36, 23}, 4));
  EXPECT_TRUE(clear({10, 20}, {10, 26}, .2));
  EXPECT_TRUE(clear({10, 50}, {36, 50}, .4));
  EXPECT_TRUE(clear({10, 24}, {12, 23}, .4));
  // The file's lifted travel is no reason to be lower there.
  EXPECT_FALSE(clear({36, 21}, {12, 21.5}, .4));
  // A slope that is above the tower only behind it.
  EXPECT_FALSE(beside->IsClear({10, 23}, .2, {36, 23}, 5));
  EXPECT_TRUE(beside->IsClear({10, 40}, .2, {10, 40}, 5));
  EXPECT_FALSE(beside->IsClear({23, 20}, .2, {23, 20}, 5));
}

TEST(HeadRoom, MovesThatAreNotClearAreCounted) {
  const auto file = Read(BesideATower());
  const HeadRoom room(*file);
  const gcode::Layer& layer = file->layers[20];
  const PartStart start = StartBehind(*file, file->blocks[layer.first_block]);
  const auto blocked = [&](const std::string& text) {
    return Measure(*file, text, start, nullptr, room.Of(20)).blocked;
  };

  EXPECT_EQ(blocked("G1 X10 Y50\nG1 X36 Y50\nG1 X36 Y26\n"), 0);
  EXPECT_EQ(blocked("G1 X36 Y23\n"), 1);
  EXPECT_EQ(blocked("G1 Z5\nG1 X36 Y23\nG1 Z.2\n"), 0);
  EXPECT_EQ(blocked("G1 Z5\nG1 X23 Y20\nG1 Z.2\nG1 X36 Y23\n"), 2);
}

TEST(HeadRoom, WhereTheFileLeadsItMayBeLedAgainInAnyDirection) {
  // Through a tower of 1 mm, from outside of what is printed.
  std::string tower = "M83\n";
  for (int layer = 1; layer <= 5; ++layer) {
    absl::StrAppend(&tower, LayerAt(0.2 * layer));
    for (double x = 20; x < 30; x += 0.4) absl::StrAppend(&tower, LineAt(x, 20, 30));
  }
  for (double x = 18; x < 28; x += 0.37) {
    const std::string travel = absl::StrCat("G1 X", x, " Y5\nG1 X", 46 - x, " Y60\n");
    const auto file =
        Read(tower + LayerAt(.2) + "G1 Z.6\n" + travel + "G1 Z.2\n" + LineAt(10, 60, 65));
    const HeadRoom room(*file);
    ASSERT_NE(room.Of(5), nullptr);
    const auto blocked = [&](const std::string& text) {
      const PartStart start = StartBehind(*file, file->blocks[file->layers[4].end_block - 1]);
      return Measure(*file, text, start, nullptr, room.Of(5)).blocked;
    };

    EXPECT_EQ(blocked("G1 Z.6 F9000\n" + travel), 0) << travel;
    EXPECT_GT(blocked(absl::StrCat("G1 Z.6 F9000\nG1 X", x - 1, " Y5\nG1 X", 46 - x, " Y60\n")), 0);
  }
}

TEST(HeadRoom, AllOfWhatIsPrintedStandsNotOnlyTheEndsOfItsSegments) {
  // A line from Y10 to Y30 that is printed one way, and a circle of two arcs from X40 to X60.
  std::string print = "M83\n";
  for (int layer = 1; layer <= 5; ++layer) {
    absl::StrAppend(&print, LayerAt(0.2 * layer), LineAt(20, 10, 30), "G1 X40 Y30 F9000\n",
                    "G3 X60 I10 J0 E1 F1800\nG3 X40 I-10 J0 E1\n");
  }
  const auto file =
      Read(print + "G1 Z6\nG1 X0 Y0\nG1 X90 Y50\n" + LayerAt(.2) + LineAt(80, 28, 32));
  const HeadRoom room(*file);
  ASSERT_NE(room.Of(5), nullptr);

  EXPECT_FALSE(room.Of(5)->IsClear({10, 12}, .2, {30, 12}, .2));
  EXPECT_FALSE(room.Of(5)->IsClear({50, 10}, .2, {50, 25}, .2));
  EXPECT_FALSE(room.Of(5)->IsClear({50, 35}, .2, {50, 50}, .2));
}

TEST(HeadRoom, OfALargePlateTakesLittleMemory) {
  // Towers all over a plate of 400 mm, then 1,500 low layers that go down again and again.
  std::string print = "M83\n";
  for (int layer = 1; layer <= 20; ++layer) {
    absl::StrAppend(&print, LayerAt(0.2 * layer));
    for (int x = 0; x < 400; x += 25) {
      for (int y = 0; y < 400; y += 50) absl::StrAppend(&print, LineAt(x, y, y + 8));
    }
  }
  for (int layer = 1; layer <= 1500; ++layer) {
    absl::StrAppend(&print, LayerAt(0.2 * (1 + layer % 20)));
    for (int x = 10; x < 400; x += 40) absl::StrAppend(&print, LineAt(x, 0, 400));
  }
  const auto file = Read(print);
  std::ofstream("/proc/self/clear_refs") << 5 << std::flush;  // the peak is what is used now
  const int64_t before_kb = PeakKb();

  const HeadRoom room(*file);

  EXPECT_NE(room.Of(21), nullptr);
  // Sanitizers keep what was freed.
  EXPECT_LT(PeakKb() - before_kb, (::traverse::testing::kSanitized ? 60 : 20) << 10);
}

}  // namespace
}  // namespace traverse::gcode
