// Lines as paths and what stands between them: client/gcode/read/block_builder.

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "client/gcode/model/block_feature.h"
#include "tests/client/gcode/read/block_text.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/samples.h"

namespace traverse::gcode {
namespace {

using testing::Read;

TEST(BlockBuilder, FindsThePathsOfCuraEngineWithTheirTails) {
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

TEST(BlockBuilder, ALayerIsARunAtOneHeight) {
  const auto file = Read("M83\nG1 X1 E1\nG0 X5\nG1 X6 E1\nG1 Z1\nG0 X7\nG1 X8 E1\n");

  ASSERT_EQ(file->layers.size(), 2u);
  EXPECT_EQ(file->layers[0].end_block, 2u);
  EXPECT_EQ(file->layers[1].z, kDecimalOne);
}

// OrcaSlicer begins outer walls low, and lets them rise to the height of the layer.
TEST(BlockBuilder, ScarfSeamsDoNotEndALayer) {
  const std::string level = "G0 X5\nG1 X6 E1\n";
  const std::string scarf = "G0 X7 Z.2\nG1 X8 Z.6 E1\nG1 X9 Z1 E1\nG1 Y3 E1\n";
  for (const std::string& layer : {level + scarf + level, scarf + scarf + level}) {
    const auto file = Read("M83\nG1 X1 E1\n;LAYER_CHANGE\nG1 Z1\n" + layer + "G1 Z2\n" + level);

    ASSERT_EQ(file->layers.size(), 3u) << layer;
    EXPECT_EQ(file->layers[1].z, kDecimalOne);
    EXPECT_EQ(file->layers[2].first_block, 4u);
  }
}

TEST(BlockBuilder, LiftsDoNotEndALayer) {
  const auto file = Read("M83\nG1 X1 E1\nG1 E-1\nG1 Z.5\nG0 X5\nG1 Z0\nG1 E1\nG1 X6 E1\n");

  EXPECT_EQ(file->layers.size(), 1u);
  EXPECT_EQ(file->blocks[1].link, kLinkRetracts);
}

TEST(BlockBuilder, WhatItDoesNotKnowFixesThePathsOnEitherSide) {
  for (const char* line :
       {"M600", "G28", "G4 P5", "T1", "M82", "G20", "G91\nG1 Z1\nG90", "PARK_HEAD", "N5 G1 X4*7"}) {
    const auto file = Read(std::string("M83\nG1 X1 E1\nG0 X5\n") + line + "\nG1 X6 E9\n");
    ASSERT_EQ(file->blocks.size(), 2u) << line;
    EXPECT_TRUE(file->blocks[1].link & kLinkFixed) << line;
  }
}

TEST(BlockBuilder, TravelBehindWhatItDoesNotKnowSetsThePathBehindItFree) {
  for (const char* line : {"M600", "G4 P5", "T1", "PARK_HEAD"}) {
    const auto file = Read(std::string("M83\nG1 X1 E1\n") + line + "\nG0 X5\nG1 X6 E9\n");
    ASSERT_EQ(file->blocks.size(), 2u) << line;
    EXPECT_EQ(file->blocks[1].link & (kLinkFixed | kLinkFixedFrom | kLinkSplits),
              kLinkFixedFrom | kLinkSplits)
        << line;
  }
}

// What is in the nozzle of another tool is not known: what is pushed first of it stays in its
// place. Rounding pushes next to nothing. Some files push a little before each path and pull
// nothing back: there it goes with the path.
TEST(BlockBuilder, APrimeBehindAToolChangeFixesThePathsOnEitherSide) {
  const auto link = [](const std::string& lines) {
    const auto file = Read("M83\nG1 X1 E1\n" + lines + "G1 X6 E9\n");
    return file->blocks.back().link & (kLinkFixed | kLinkFixedFrom);
  };
  EXPECT_EQ(link("G1 E-16\nT1\nG0 X5\nG1 E16\n"), kLinkFixed);
  EXPECT_EQ(link("G0 X5\nG1 E.8\n"), 0);
  EXPECT_EQ(link("G1 E-16\nT1\nG1 E-1\nG0 X5\nG1 E1\n"), kLinkFixedFrom);
  EXPECT_EQ(link("G1 E-.8\nG0 X5\nG1 E.8\n"), 0);
  EXPECT_EQ(link("T1\nG0 X5\nG1 E.00001\n"), kLinkFixedFrom);
}

// Scripts lead the head away by commands of one printer alone, and back by moves that state all
// axes: then it is known again where it is.
TEST(BlockBuilder, AHeadThatWasLostIsFoundWhereAllAxesAreStated) {
  const auto link = [](const std::string& lines) {
    const auto file = Read("M83\nG1 X1 Z.2 E1\n" + lines + "G1 X6 E9\n");
    return file->blocks.back().link & (kLinkFixed | kLinkFixedFrom);
  };
  const int found = kLinkFixedFrom;

  EXPECT_EQ(link("G39.3 S1\nG392 S0\nG1 Z2\nG1 X5 Y5\nG1 Z.2\n"), found);
  EXPECT_EQ(link("G28 X\nG1 X5 Y5 Z.2\n"), found);
  EXPECT_EQ(link("G28\nG1 Z.2\nG1 X5 Y5\n"), found) << "stated where it seems to be";
  EXPECT_EQ(link("G28\nG1 Z2\nG1 X5\nG1 Z.2\n"), kLinkFixed) << "no Y";
  EXPECT_EQ(link("G28\nG1 X5 Y5\n"), kLinkFixed) << "no Z";
  EXPECT_EQ(link("G28\nG1 X5 Y5 Z.2\nG392 S1\nG1 X4 Y4\n"), kLinkFixed) << "lost again";
  EXPECT_EQ(link("G28\nG2 X5 Y5 Z.2 I1\nG1 X4\n"), kLinkFixed) << "along an arc from somewhere";
  EXPECT_EQ(link("G28\nG91\nG1 X5 Y5 Z1\nG90\nG1 X4\n"), kLinkFixed) << "by as much";
}

TEST(BlockBuilder, KnownLinesSplitWithoutFixing) {
  for (const char* line : {"M104 S200", "M118 hello", "; printing object a id:0 copy 0", "M486 S1",
                           "EXCLUDE_OBJECT_START NAME=a", ";MESH:a.stl"}) {
    const auto file = Read(std::string("M83\nG1 X1 E1\nG0 X5\n") + line + "\nG1 X6 E1\n");
    EXPECT_EQ(file->blocks[1].link & (kLinkFixed | kLinkSplits), kLinkSplits) << line;
  }
}

TEST(BlockBuilder, PathsPrintedWhileRetractedOrRisingArePinned) {
  const auto file = Read("M83\nG1 E-5\nG1 X1 E1\nG0 X2\nG1 E5\nG1 X3 E1\nG0 X4\nG1 X5 Z1 E1\n");

  EXPECT_TRUE(file->blocks[0].flags & kBlockPinned);
  EXPECT_FALSE(file->blocks[1].flags & kBlockPinned);
  EXPECT_TRUE(file->blocks[2].flags & kBlockPinned);
}

// The link between a path printed while retracted and one that is not is no other's to replace.
TEST(BlockBuilder, WhatOpensOrClosesTheNozzleForAPathStays) {
  const std::string text =
      "M83\nG1 X1 E1\nG0 X2\nG1 X3 E1\nG10\nG0 X4\nG1 X5 E1\nG0 X6\nG1 X7 E1\nG0 X8\nG11\n"
      "G1 X9 E1\nG0 X10\nG1 X11 E1\n";
  const auto file = Read(text);
  ASSERT_EQ(file->blocks.size(), 6u);
  for (const size_t b : {1u, 3u, 5u}) EXPECT_EQ(file->blocks[b].link & kLinkFixed, 0) << b;
  for (const size_t b : {2u, 4u}) EXPECT_NE(file->blocks[b].link & kLinkFixed, 0) << b;
}

TEST(BlockBuilder, SegmentsThatRoundToNothingBelongToTheirPath) {
  const auto file = Read(
      "M82\nG1 X1 E1\nG1 X1.04 E1\nG1 X3 E1.00001\nG0 X9\nG1 X9.04 E1.00001\n"
      "G1 X11 E1.1\n");

  ASSERT_EQ(file->blocks.size(), 2u);
  EXPECT_EQ(file->blocks[0].end_count, 3);
  EXPECT_TRUE(file->blocks[0].flags & kBlockZero);
  EXPECT_EQ(file->blocks[1].end_count, 2);
}

TEST(BlockBuilder, TravelWithAnEThatPushesNothingBelongsToNoPathHoweverShort) {
  const auto file = Read(
      "M83\nG1 F1200 X5 E1\nG1 X5.03 E0 F9000\nG1 X9 E0\nG1 X20 E1 F1200\nG1 X20.03 E0\nG1 X30 "
      "E1\n");

  ASSERT_EQ(file->blocks.size(), 2u);
  EXPECT_FALSE(file->blocks[0].flags & kBlockZero);
  EXPECT_EQ(file->blocks[0].end_count, 1);
  EXPECT_EQ(file->blocks[1].end_count, 3);
}

TEST(BlockBuilder, AMoveThatRoundsToNothingEndsNoPath) {
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

// CuraEngine leads travel around walls from its begin on; where it retracts, it may move in before.
TEST(BlockBuilder, DepartsWhereItPullsBackBehindAShortMove) {
  const std::string head =
      ";FLAVOR:Marlin\n;Generated with Cura_SteamEngine 5.0.0\nM83\n;LAYER:0\nG0 F9000 X1 Y0\n";
  const std::string next = "G0 F9000 X0 Y9\nG1 F2400 E1\nG1 F1200 X5 E1\n";
  const auto departs = [&](const std::string& leaving) {
    return Read(head + "G1 F1200 X5 E1\n" + leaving + next)->blocks[1].link & kLinkDeparts;
  };
  EXPECT_TRUE(departs("G0 F9000 X5 Y.4\nG1 F2400 E-1\n"));
  EXPECT_FALSE(departs("G0 F9000 X5 Y.4\nG0 X4 Y3\nG1 F2400 E-1\n"));
  EXPECT_FALSE(departs("G1 F2400 E-1\nG0 F9000 X5 Y.4\n"));
}

TEST(BlockBuilder, ATailThatLeadsToTheNextPathIsTravel) {
  const auto file = Read("M83\nG1 F1200 X5 E1\nG1 X5.5 Y.5\nG1 X0 E1\n");

  ASSERT_EQ(file->blocks.size(), 2u);
  EXPECT_FALSE(file->blocks[0].flags & kBlockTail);
  EXPECT_FALSE(file->blocks[1].link & kLinkFixed);
}

// As fast as the path, but to one side, before it retracts: so travel leaves the path.
TEST(BlockBuilder, ATailThatLeadsAsideIsTravel) {
  const auto flags = [](const std::string& tail) {
    const auto file = Read("M83\nG1 X0 Y0 F9000\nG1 F1200 X5 E1\n" + tail +
                           "G1 F2400 E-1\nG1 F9000 X0 Y9\nG1 F2400 E1\nG1 F1200 X5 E1\n");
    return std::pair(file->blocks[0].flags & kBlockTail, file->blocks[1].link & kLinkDeparts);
  };
  EXPECT_EQ(flags("G1 X5.4 Y.4\n"), std::pair(0, int{kLinkDeparts}));
  EXPECT_EQ(flags("G1 X5.4\n"), std::pair(int{kBlockTail}, 0));
  // Coasting may go round a corner.
  EXPECT_EQ(flags("G1 X5.4 Y.4 F1100\n"), std::pair(int{kBlockTail}, 0));
  EXPECT_EQ(flags("G1 X5.1\nG1 X5.1 Y.4\n"), std::pair(int{kBlockTail}, 0));
}

TEST(BlockBuilder, ATailThatGoesOnStaysWithItsPath) {
  // The next path begins where the infill's wipe ended.
  const auto file = Read("M83\nG1 F1200 X5 E1\nG1 X5.5\nG1 X5.5 Y9 E1\nG0 X9\nG1 X20 E1\n");

  ASSERT_EQ(file->blocks.size(), 3u);
  EXPECT_TRUE(file->blocks[0].flags & kBlockTail);
  EXPECT_FALSE(file->blocks[1].link & kLinkFixed);
}

// Slicers and post-processors write the feed rate on a line of its own, too.
TEST(BlockBuilder, ATailOfTwoMovesMayStateItsFeedRateBetweenThem) {
  const std::string path = "M83\nG1 X0 Y0 F9000\nG1 F1200 X5 E1\n";
  const std::string next = "G1 F9000\nG1 X0 Y9\nG1 F1200\nG1 X5 E1\n";
  const auto file = Read(path + "G1 F1200\nG1 X5.5\nG1 F1200\nG1 X6 Y.1\n" + next);

  ASSERT_EQ(file->blocks.size(), 2u);
  EXPECT_TRUE(file->blocks[0].flags & kBlockTail);
  EXPECT_EQ(ToDouble(file->blocks[0].last.x), 6);
  // What is faster is travel.
  const auto travels = Read(path + "G1 F1200\nG1 X5.5\nG1 F1300\nG1 X6 Y.1\n" + next);
  EXPECT_EQ(ToDouble(travels->blocks[0].last.x), 5.5);
}

}  // namespace
}  // namespace traverse::gcode
