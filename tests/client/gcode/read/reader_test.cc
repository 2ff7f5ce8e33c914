// Whole files of sliced G-code: client/gcode/read/reader.

#include "client/gcode/read/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/block_feature.h"
#include "client/gcode/model/outline.h"
#include "tests/client/gcode/read/block_text.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/samples.h"
#include "tests/client/gcode/support/verified.h"

namespace traverse::gcode {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Read;
using ::testing::StartsWith;

std::string Fault(const std::string& text) {
  const absl::StatusOr<std::shared_ptr<GcodeFile>> file = ReadGcode(text, "part.gcode");
  return file.ok() ? "" : std::string(file.status().message());
}

TEST(ReadGcode, FindsThePathsOfPrusaSlicer) {
  const auto file = Read(testing::kPrusaSample);

  EXPECT_EQ(file->slicer.name, "PrusaSlicer 2.5.0");
  ASSERT_EQ(file->layers.size(), 1u);
  ASSERT_EQ(file->blocks.size(), 3u);
  EXPECT_EQ(TextOf(*file, file->blocks[2]), "G1 X30 Y31 E.4\n");
  EXPECT_EQ(file->blocks[0].link & kLinkFixed, kLinkFixed);
  EXPECT_EQ(file->blocks[1].link, kLinkRetracts | kLinkWipes);
  EXPECT_EQ(file->blocks[2].link, 0);
  EXPECT_EQ(file->blocks[0].flags, kBlockProgress | kBlockOwnFan);
  EXPECT_EQ(file->progress.size(), 1u);
  EXPECT_TRUE(file->feed_on_own_line);
}

TEST(ReadGcode, LoopsMayEndShortOfTheirStart) {
  const auto file = Read(testing::kPrusaSample);

  const Outline loop = OutlineOf(*file, file->blocks[0]);
  const Outline line = OutlineOf(*file, file->blocks[1]);

  EXPECT_TRUE(loop.closed);
  EXPECT_NE(loop.points.front(), loop.points.back());
  EXPECT_EQ(loop.feature, Feature::kInnerWall);
  EXPECT_DOUBLE_EQ(loop.width_mm, 0.45);
  EXPECT_FALSE(line.closed);
  EXPECT_EQ(line.feature, Feature::kSparseInfill);
}

// Where a file says neither, lines are as wide as their filament fills in a layer of its height.
TEST(ReadGcode, WidthsAreThoseOfTheHeightOfTheLayer) {
  const auto file = Read(
      "M83\n;LAYER:0\nG1 Z.5 F600\nG1 X0 Y0\nG1 X10 E1\nG1 X0 Y5\nG1 X10 E1\n"
      ";LAYER:1\nG1 Z.9\nG1 X0 Y0\nG1 X10 E1\n;LAYER:2\nG1 Z.9\nG1 X0 Y9\nG1 X10 E1\n"
      ";LAYER:0\nG1 Z.3\nG1 X40 Y0\nG1 X50 E1\n");
  std::vector<double> heights;
  std::vector<double> widths;
  for (const Layer& layer : file->layers) heights.push_back(layer.height_mm);
  for (const Block& block : file->blocks) widths.push_back(OutlineOf(*file, block).width_mm);

  EXPECT_THAT(heights, ElementsAre(DoubleNear(0.5, 1e-9), DoubleNear(0.4, 1e-9),
                                   DoubleNear(0.4, 1e-9), DoubleNear(0.3, 1e-9)));
  // 0.2405 mm2, less the round sides.
  EXPECT_THAT(widths,
              ElementsAre(DoubleNear(0.588, 1e-3), DoubleNear(0.588, 1e-3), DoubleNear(0.687, 1e-3),
                          DoubleNear(0.687, 1e-3), DoubleNear(0.866, 1e-3)));
}

TEST(ReadGcode, StateIsThatOfTheFirstSegment) {
  const auto file = Read(testing::kPrusaSample);

  const auto line_of = [&file](size_t block, Slot slot) {
    return file->setters.Line(file->states[file->blocks[block].state_in][slot]);
  };

  EXPECT_EQ(line_of(0, kSlotPrintAccel), "M204 P500");
  EXPECT_EQ(line_of(1, kSlotPrintAccel), "M204 P800");
  EXPECT_EQ(line_of(1, kSlotType), ";TYPE:Internal infill");
  EXPECT_EQ(file->blocks[1].feed_in, 4800 * kDecimalOne);
}

TEST(ReadGcode, WhatCountsFromTheMoveBeforeNeedNotSaySo) {
  const auto relative = Read("G1 X1 E.3\nG1 X2 E.3\nG1 X3 E.2\nG0 X9\nG1 X10 E.3\n");
  const auto absolute = Read("G1 X1 E.3\nG1 X2 E.6\nG1 X3 E.8\nG0 X9\nG1 X10 E1.1\n");

  EXPECT_TRUE(relative->modes[0].relative_e);
  EXPECT_EQ(relative->blocks[0].end_count, 3);
  EXPECT_FALSE(absolute->modes[0].relative_e);
}

// In whatever letters: nothing is guessed then, which other orders of its words might change.
TEST(ReadGcode, AFileMaySayHowItCountsInSmallLetters) {
  const std::string words = "g1 x1 e.3\ng1 x2 e.3\ng1 x3 e.2\ng0 x9\ng1 x10 e.3\n";
  for (const std::string mode : {"m82\n", "  M82\n", "\tm82 ; absolute\n"}) {
    const auto file = Read("g21\n" + mode + words);
    EXPECT_FALSE(file->modes[0].relative_e) << mode;
    EXPECT_EQ(file->blocks[0].link & kLinkFixed, kLinkFixed);
    const std::string relative = "g21\nm83\n" + words;
    EXPECT_EQ(VerifyGcode(relative, "a", relative, "b").message(), "");
  }
  EXPECT_TRUE(Read("; m82\n" + words)->modes[0].relative_e);
}

TEST(ReadGcode, LineEndsDoNotMatter) {
  const auto unix_file = Read(testing::kCuraSample);
  const auto dos_file = Read(testing::WithCrLf(testing::kCuraSample));

  ASSERT_EQ(dos_file->blocks.size(), unix_file->blocks.size());
  EXPECT_EQ(Sum(MeasureLayers(*dos_file)).travel_mm, Sum(MeasureLayers(*unix_file, 2)).travel_mm);
  EXPECT_EQ(dos_file->slicer.name, unix_file->slicer.name);
}

TEST(ReadGcode, NamesThePlaceOfAFault) {
  EXPECT_EQ(Fault(std::string("G28\nG1 X\0 E1\n", 14)), "part.gcode:2: NUL byte: this is not text");
  EXPECT_EQ(Fault("G28\nG1 X5\n"), "part.gcode: no extruding move");
  EXPECT_THAT(Fault(""), HasSubstr("no extruding move"));
  EXPECT_THAT(Fault("M83\rG1 X5 E1\r"), HasSubstr("carriage returns alone"));
  EXPECT_EQ(Fault("G28\r\nG1 X5\r\n"), "part.gcode: no extruding move");
  EXPECT_EQ(Fault("N1 G28*18\nN2 G1 X5 E1*3\n"),
            "part.gcode:2: its number or checksum does not follow from those of the other lines");
  EXPECT_EQ(Fault("G28\nN1 G1 X5 E1\nN2 G1 X6 E1\nN4 G1 X7 E1\n"),
            "part.gcode:4: its number or checksum does not follow from those of the other lines");
}

TEST(ReadGcode, SaysWhichMoveItDoesNotFollowWhereItFollowsNone) {
  EXPECT_THAT(Fault("M83\nG90\nG1 Z.2\nG91\nG1 X5\nG1 E-.5\nG1 X10 E.5\nG1 Y10 E.5\n"),
              StartsWith("part.gcode:7: no extruding move with absolute coordinates (G90)"));
  EXPECT_THAT(Fault("M83\nG1 X5\nG1.0 X9 E.5\n"),
              StartsWith("part.gcode:3: no extruding move that can be read"));
  EXPECT_THAT(Fault("M83\nG1 X5\nG1 X" + std::string(399, '1') + " E.5\n"),
              StartsWith("part.gcode:3: no extruding move that can be read"));
  EXPECT_THAT(Fault("M83\ng1 X5 X5 E.5\n"), StartsWith("part.gcode:2: no extruding move that can"));
  // These print nothing, however they are read.
  EXPECT_EQ(Fault("G91\nG1 X5\nG1 E1\nG1 X5 X5\nG28 E1\n; G1 X1 X1 E1\n"),
            "part.gcode: no extruding move");
}

TEST(ReadGcode, NumberedLinesAreReadWithoutTheirNumbers) {
  const auto file = Read("N1 M83*25\nN2 G1 X5 E1*51\n");

  EXPECT_EQ(file->text, "M83\nG1 X5 E1\n");
  EXPECT_EQ(file->blocks.size(), 1u);
}

// Marlin says that this is no arc and goes on, Klipper ends the print.
TEST(ReadGcode, AnArcWithoutCenterKeepsItsLayerAndNoOther) {
  const std::string path = "G1 X9 Y9 F9000\nG1 X5 Y5 E1 F900\nG1 X1 Y9 F9000\nG1 X5 Y7 E1 F900\n";
  const auto file =
      Read("M83\nG1 Z.2\n" + path + "G1 Z.4\n" + path + "G2 X7 Y7 E1\n" + path + "G1 Z.6\n" + path);

  ASSERT_EQ(file->layers.size(), 3u);
  EXPECT_EQ(file->layers[0].fault, nullptr);
  EXPECT_STREQ(file->layers[1].fault, "G2 without I, J or R");
  EXPECT_EQ(file->Place(file->layers[1].fault_at), file->name + ":12");
  EXPECT_EQ(file->layers[2].fault, nullptr);
  for (uint32_t b = file->layers[1].first_block; b < file->layers[1].end_block; ++b) {
    EXPECT_TRUE(file->blocks[b].flags & kBlockPinned);
  }
  EXPECT_FALSE(file->blocks[0].flags & kBlockPinned);
}

TEST(ReadGcode, AFileMayEndAnywhere) {
  const std::string sample = testing::kCuraSample;
  for (size_t length = 0; length <= sample.size(); ++length) {
    const auto file = ReadGcode(sample.substr(0, length), "part.gcode");
    if (file.ok()) {
      EXPECT_LE((*file)->blocks.back().end, length);
    }
  }
}

TEST(ReadGcode, LongLinesAreLinesLikeOthers) {
  const std::string thumbnail = "; " + std::string(2 << 20, 'A') + "\n";
  const std::string garbage = std::string(2 << 20, 'Q') + "\n";

  EXPECT_EQ(Read(thumbnail + testing::kPrusaSample)->blocks.size(), 3u);
  const auto file = Read("M83\nG1 X1 E1\nG0 X5\n" + garbage + "G1 X6 E1\n");
  EXPECT_TRUE(file->blocks[1].link & kLinkFixed);
}

}  // namespace
}  // namespace traverse::gcode
