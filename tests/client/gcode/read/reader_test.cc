#include "client/gcode/read/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/feature.h"
#include "client/gcode/model/outline.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/samples.h"

namespace traverse::gcode {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Read;

std::string Fault(const std::string& text) {
  const absl::StatusOr<std::shared_ptr<GcodeFile>> file = ReadGcode(text, "part.gcode");
  return file.ok() ? "" : std::string(file.status().message());
}

std::string TextOf(const GcodeFile& file, const Block& block) {
  return file.text.substr(block.begin, block.end - block.begin);
}

TEST(ReadGcode, FindsThePathsOfPrusaSlicer) {
  const auto file = Read(testing::kPrusaSample);

  EXPECT_EQ(file->slicer, "PrusaSlicer 2.5.0");
  EXPECT_EQ(file->dialect, Dialect::kPrusa);
  ASSERT_EQ(file->layers.size(), 1u);
  ASSERT_EQ(file->blocks.size(), 3u);
  EXPECT_EQ(TextOf(*file, file->blocks[2]), "G1 X30 Y31 E.4\n");
  EXPECT_EQ(file->blocks[0].link & kLinkFixed, kLinkFixed);
  EXPECT_EQ(file->blocks[1].link, kLinkRetracts | kLinkWipes);
  EXPECT_EQ(file->blocks[2].link, 0);
  EXPECT_EQ(file->blocks[0].flags, kBlockProgress);
  EXPECT_EQ(file->progress.size(), 1u);
  EXPECT_TRUE(file->feed_on_own_line);
}

TEST(ReadGcode, LoopsMayEndShortOfTheirStart) {
  const auto file = Read(testing::kPrusaSample);

  const Outline loop = OutlineOf(*file, file->blocks[0]);
  const Outline line = OutlineOf(*file, file->blocks[1]);

  EXPECT_TRUE(loop.closed);
  EXPECT_FALSE(loop.exactly_closed);
  EXPECT_EQ(loop.feature, Feature::kInnerWall);
  EXPECT_DOUBLE_EQ(loop.width_mm, 0.45);
  EXPECT_FALSE(line.closed);
  EXPECT_EQ(line.feature, Feature::kSparseInfill);
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

TEST(ReadGcode, FindsThePathsOfCuraEngineWithTheirTails) {
  const auto file = Read(testing::kCuraSample);

  ASSERT_EQ(file->blocks.size(), 4u);
  ASSERT_EQ(file->layers.size(), 2u);
  EXPECT_EQ(file->blocks[0].flags & (kBlockTail | kBlockCoast), kBlockTail | kBlockCoast);
  EXPECT_EQ(file->blocks[1].flags & (kBlockTail | kBlockCoast), kBlockTail);
  EXPECT_EQ(TextOf(*file, file->blocks[1]), "G1 F1200 X19 Y11 E1.9\nG1 X19.04 Y11\n");
  EXPECT_EQ(file->blocks[2].flags, 0);
  EXPECT_EQ(file->layers[1].first_block, 3u);
  // ;TYPE stands before the prime, and is the next path's all the same.
  EXPECT_EQ(FeatureOf(*file, file->blocks[3], false), Feature::kSparseInfill);
}

TEST(ReadGcode, ALayerIsARunAtOneHeight) {
  const auto file = Read("M83\nG1 X1 E1\nG0 X5\nG1 X6 E1\nG1 Z1\nG0 X7\nG1 X8 E1\n");

  ASSERT_EQ(file->layers.size(), 2u);
  EXPECT_EQ(file->layers[0].end_block, 2u);
  EXPECT_EQ(file->layers[1].z, kDecimalOne);
}

TEST(ReadGcode, LiftsDoNotEndALayer) {
  const auto file = Read("M83\nG1 X1 E1\nG1 E-1\nG1 Z.5\nG0 X5\nG1 Z0\nG1 E1\nG1 X6 E1\n");

  EXPECT_EQ(file->layers.size(), 1u);
  EXPECT_EQ(file->blocks[1].link, kLinkRetracts | kLinkLifts);
}

TEST(ReadGcode, WhatItDoesNotKnowFixesThePathsOnEitherSide) {
  for (const char* line : {"M600", "G28", "G4 P5", "T1", "M82", "G20", "G91\nG1 Z1\nG90",
                           "TIMELAPSE_TAKE_FRAME", "N5 G1 X4*7"}) {
    const auto file = Read(std::string("M83\nG1 X1 E1\nG0 X5\n") + line + "\nG1 X6 E9\n");
    ASSERT_EQ(file->blocks.size(), 2u) << line;
    EXPECT_TRUE(file->blocks[1].link & kLinkFixed) << line;
  }
}

TEST(ReadGcode, TravelBehindWhatItDoesNotKnowSetsThePathBehindItFree) {
  for (const char* line : {"M600", "G4 P5", "T1", "TIMELAPSE_TAKE_FRAME"}) {
    const auto file = Read(std::string("M83\nG1 X1 E1\n") + line + "\nG0 X5\nG1 X6 E9\n");
    ASSERT_EQ(file->blocks.size(), 2u) << line;
    EXPECT_EQ(file->blocks[1].link & (kLinkFixed | kLinkFixedFrom | kLinkSplits),
              kLinkFixedFrom | kLinkSplits)
        << line;
  }
}

TEST(ReadGcode, WhatCountsFromTheMoveBeforeNeedNotSaySo) {
  const auto relative = Read("G1 X1 E.3\nG1 X2 E.3\nG1 X3 E.2\nG0 X9\nG1 X10 E.3\n");
  const auto absolute = Read("G1 X1 E.3\nG1 X2 E.6\nG1 X3 E.8\nG0 X9\nG1 X10 E1.1\n");

  EXPECT_TRUE(relative->modes[0].relative_e);
  EXPECT_EQ(relative->blocks[0].segments, 3);
  EXPECT_FALSE(absolute->modes[0].relative_e);
}

TEST(ReadGcode, KnownLinesSplitWithoutFixing) {
  for (const char* line : {"M104 S200", "M117 hello", "; printing object a id:0 copy 0", "M486 S1",
                           "EXCLUDE_OBJECT_START NAME=a", ";MESH:a.stl"}) {
    const auto file = Read(std::string("M83\nG1 X1 E1\nG0 X5\n") + line + "\nG1 X6 E1\n");
    EXPECT_EQ(file->blocks[1].link & (kLinkFixed | kLinkSplits), kLinkSplits) << line;
  }
}

TEST(ReadGcode, PathsPrintedWhileRetractedOrRisingArePinned) {
  const auto file = Read("M83\nG1 E-5\nG1 X1 E1\nG0 X2\nG1 E5\nG1 X3 E1\nG0 X4\nG1 X5 Z1 E1\n");

  EXPECT_TRUE(file->blocks[0].flags & kBlockPinned);
  EXPECT_FALSE(file->blocks[1].flags & kBlockPinned);
  EXPECT_TRUE(file->blocks[2].flags & kBlockPinned);
}

TEST(ReadGcode, SegmentsThatRoundToNothingBelongToTheirPath) {
  const auto file = Read(
      "M82\nG1 X1 E1\nG1 X1.04 E1\nG1 X3 E1.00001\nG0 X9\nG1 X9.04 E1.00001\n"
      "G1 X11 E1.1\n");

  ASSERT_EQ(file->blocks.size(), 2u);
  EXPECT_EQ(file->blocks[0].segments, 3);
  EXPECT_TRUE(file->blocks[0].flags & kBlockZero);
  EXPECT_EQ(file->blocks[1].segments, 2);
}

TEST(ReadGcode, TravelWithAnEThatPushesNothingBelongsToNoPathHoweverShort) {
  const auto file = Read(
      "M83\nG1 F1200 X5 E1\nG1 X5.03 E0 F9000\nG1 X9 E0\nG1 X20 E1 F1200\nG1 X20.03 E0\nG1 X30 "
      "E1\n");

  ASSERT_EQ(file->blocks.size(), 2u);
  EXPECT_FALSE(file->blocks[0].flags & kBlockZero);
  EXPECT_EQ(file->blocks[0].segments, 1);
  EXPECT_EQ(file->blocks[1].segments, 3);
}

TEST(ReadGcode, AMoveThatRoundsToNothingEndsNoPath) {
  const std::string head = "M83\nG1 X1 Y0 F900\nG1 X5 E1\n";
  const std::string tail = "G1 X9 E1\nG1 X9 Y9 F9000\nG1 X5 E1\n";

  const auto speck = Read(head + "G1 X5 Y0 E.00003\n" + tail);
  ASSERT_EQ(speck->blocks.size(), 2u);
  EXPECT_TRUE(speck->blocks[0].flags & kBlockCommand);
  EXPECT_FALSE(speck->blocks[1].link & kLinkFixed);
  // What is pushed without words of a place, or is more than rounding leaves, is a blob.
  EXPECT_EQ(Read(head + "G1 E.00003\n" + tail)->blocks.size(), 3u);
  EXPECT_EQ(Read(head + "G1 X5 Y0 E.1\n" + tail)->blocks.size(), 3u);
}

TEST(ReadGcode, ATailThatLeadsToTheNextPathIsTravel) {
  const auto file = Read("M83\nG1 F1200 X5 E1\nG1 X5.5 Y.5\nG1 X0 E1\n");

  ASSERT_EQ(file->blocks.size(), 2u);
  EXPECT_FALSE(file->blocks[0].flags & kBlockTail);
  EXPECT_FALSE(file->blocks[1].link & kLinkFixed);
}

TEST(ReadGcode, ATailThatGoesOnStaysWithItsPath) {
  // The next path begins where the infill's wipe ended.
  const auto file = Read("M83\nG1 F1200 X5 E1\nG1 X5.5\nG1 X5.5 Y9 E1\nG0 X9\nG1 X20 E1\n");

  ASSERT_EQ(file->blocks.size(), 3u);
  EXPECT_TRUE(file->blocks[0].flags & kBlockTail);
  EXPECT_FALSE(file->blocks[1].link & kLinkFixed);
}

TEST(ReadGcode, LineEndsDoNotMatter) {
  const auto unix_file = Read(testing::kCuraSample);
  const auto dos_file = Read(testing::WithCrLf(testing::kCuraSample));

  ASSERT_EQ(dos_file->blocks.size(), unix_file->blocks.size());
  EXPECT_EQ(Sum(MeasureLayers(*dos_file)).travel_mm, Sum(MeasureLayers(*unix_file, 2)).travel_mm);
  EXPECT_EQ(dos_file->slicer, unix_file->slicer);
}

TEST(ReadGcode, NamesThePlaceOfAFault) {
  EXPECT_EQ(Fault(std::string("G28\nG1 X\0 E1\n", 14)), "part.gcode:2: NUL byte: this is not text");
  EXPECT_EQ(Fault("G28\nG1 X5\n"), "part.gcode: no extruding move");
  EXPECT_THAT(Fault(""), HasSubstr("no extruding move"));
  EXPECT_THAT(Fault("M83\rG1 X5 E1\r"), HasSubstr("carriage returns alone"));
  EXPECT_EQ(Fault("G28\r\nG1 X5\r\n"), "part.gcode: no extruding move");
  EXPECT_EQ(Fault("N1 G28*18\nN2 G1 X5 E1*3\n"),
            "part.gcode:2: its number or checksum is not what those of the other lines lead to");
  EXPECT_EQ(Fault("G28\nN1 G1 X5 E1\nN2 G1 X6 E1\nN4 G1 X7 E1\n"),
            "part.gcode:4: its number or checksum is not what those of the other lines lead to");
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
  EXPECT_EQ(file->LineNumber(file->layers[1].fault_at), 12u);
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
