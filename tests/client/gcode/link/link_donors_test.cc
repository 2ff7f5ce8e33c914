// Which travel moves of a file others may follow.

#include "client/gcode/link/link_donors.h"

#include <gtest/gtest.h>

#include <memory>

#include "client/gcode/link/link.h"
#include "client/gcode/write/layer_writer.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

// The short move at the end of the second line belongs to that line, and the third one begins
// there. Who follows that would go nowhere, and the writer would look for a retracted travel
// instead.
TEST(LinkDonors, WherePathsMeetThereIsNoTravelToFollow) {
  Sketch sketch;
  sketch.Infill(10, 0).Go(10, 2).Infill(0, 2).Add("G1 X-.1 Y2");
  sketch.Infill(-.1, 4).GoRetracted(0, 6).Infill(10, 6);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_EQ(file->blocks.size(), 4u);
  ASSERT_EQ(file->blocks[2].travel_mm, 0);
  const LinkDonors donors(*file);

  for (const uint32_t to : {1u, 2u, 3u}) EXPECT_EQ(donors.Find(to, false), 1u) << to;
  EXPECT_EQ(donors.Find(2, true), 3u);
  EXPECT_GE(ReadLink(*file, *donors.Find(2, false)).arrival, 0);
}

// CuraEngine sometimes retracts and primes once more where a travel move has arrived. That costs
// time, and no other way needs it.
TEST(LinkDonors, TravelsThatRetractAgainAreNoExample) {
  Sketch sketch;
  sketch.Infill(10, 0).GoRetracted(0, 2).Add("G1 E-.8 F2100").Add("G1 E.8").Infill(10, 2);
  sketch.GoRetracted(0, 4).Infill(10, 4).Add("G1 E-.4 F2100").Add("G1 E-.4").Go(0, 6);
  sketch.Add("G1 E.4").Add("G1 E.4").Infill(10, 6);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_EQ(file->blocks.size(), 4u);
  const LinkDonors donors(*file);

  EXPECT_FALSE(donors.MayFollow(1));
  EXPECT_TRUE(donors.MayFollow(2));
  EXPECT_TRUE(donors.MayFollow(3)) << "pulled back in two parts";
  EXPECT_EQ(donors.Find(1, true), 2u);
}

// Where the travel to follow is of another layer, one of the own layer tells how fast travel moves
// are.
TEST(LinkDonors, TheLayerTellsHowFastItsTravelsAre) {
  Sketch sketch;
  sketch.Infill(10, 0).GoRetracted(0, 2).Infill(10, 2).Go(10, 4).Infill(0, 4);
  sketch.Add("G1 Z.4 F9000").Go(0, 0).Infill(10, 0).Go(10, 2).Infill(0, 2);
  sketch.Add("G1 Z.6 F9000").Infill(10, 0);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_EQ(file->layers.size(), 3u);
  ASSERT_EQ(file->blocks.size(), 6u);
  const LinkDonors donors(*file);

  ASSERT_EQ(donors.Find(4, true), 1u);
  EXPECT_EQ(donors.PaceFor(4, 1), 4u) << "no way of its layer retracts";
  EXPECT_EQ(donors.PaceFor(2, 1), std::nullopt) << "of the same layer";
  EXPECT_EQ(donors.PaceFor(5, 1), std::nullopt) << "a layer of one path";
}

}  // namespace
}  // namespace traverse::gcode
