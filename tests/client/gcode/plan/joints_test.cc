#include "client/gcode/plan/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "client/gcode/model/loops.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

// Printed at 20 mm/s, with the 1250 mm/s^2 and 5 mm/s of a file that states none.
struct JoinedLayer {
  explicit JoinedLayer(const Sketch& sketch)
      : file(sketch.Read()),
        outlines(OutlinesOf(*file, file->layers[0])),
        joints(*file, file->layers[0], outlines) {}

  const std::shared_ptr<GcodeFile> file;
  const std::vector<Outline> outlines;
  const LayerJoints joints;
};

void ExpectAlong(const Joint& joint, double x, double y) {
  EXPECT_NEAR(joint.along.x, x, 1e-9);
  EXPECT_NEAR(joint.along.y, y, 1e-9);
}

TEST(LayerJoints, OfALineLieInItsDirection) {
  const JoinedLayer layer(Sketch().Infill(10, 0));

  ExpectAlong(layer.joints.BeginOf(0, 0), 1, 0);
  ExpectAlong(layer.joints.EndOf(0, 0), 1, 0);
  ExpectAlong(layer.joints.BeginOf(0, 1), -1, 0);
  ExpectAlong(layer.joints.EndOf(0, 1), -1, 0);
  EXPECT_NEAR(layer.joints.EndOf(0, 1).speed_mm_s, 20, 1e-9);
  EXPECT_NEAR(layer.joints.EndOf(0, 1).accel_mm_s2, 1250, 1e-9);
}

TEST(LayerJoints, OfASquareAreThoseOfTheSidesAtItsStart) {
  const JoinedLayer layer(Sketch().Square(0, 0, 10));
  ASSERT_TRUE(layer.outlines[0].closed);

  ExpectAlong(layer.joints.BeginOf(0, 0), 1, 0);
  ExpectAlong(layer.joints.EndOf(0, 0), 0, -1);
  ExpectAlong(layer.joints.BeginOf(0, 1), 0, 1);
  ExpectAlong(layer.joints.EndOf(0, 1), 1, 0);
  ExpectAlong(layer.joints.BeginOf(0, 3), 0, -1);
  ExpectAlong(layer.joints.EndOf(0, 3), -1, 0);
}

TEST(LayerJoints, BehindACornerAShortSegmentIsTooShortToGetGoing) {
  const JoinedLayer layer(Sketch().Infill(10, 0).Infill(10, .05));
  ASSERT_EQ(layer.outlines.size(), 1u);

  // 5 mm/s at a right angle, and 0.05 mm from there.
  EXPECT_NEAR(layer.joints.EndOf(0, 0).speed_mm_s, std::sqrt(25 + 2 * 1250 * .05), 1e-6);
  EXPECT_NEAR(layer.joints.BeginOf(0, 0).speed_mm_s, 20, 1e-9);
}

TEST(StopSeconds, AreWhatGettingGoingLoses) {
  EXPECT_NEAR(StopSeconds({{1, 0}, 20, 1250}), .008, 1e-12);
  EXPECT_EQ(StopSeconds({}), 0);
}

// Both travel moves are of the same length and angle: between them is what the loop takes by
// itself.
TEST(LayerJoints, ALoopBegunStraightOnTakesLongerByItsStop) {
  Sketch sketch;
  sketch.Add("G1 F9000").Square(0, 0, 30);
  const JoinedLayer square(sketch);
  ASSERT_TRUE(square.outlines[0].closed);
  for (uint32_t corner = 0; corner < 4; ++corner) {
    EXPECT_NEAR(square.joints.RestartSeconds(0, corner), 0, 1e-9);
  }

  // Begun at a corner, and at the middle of a side.
  Sketch drawn;
  drawn.Add(";TYPE:External perimeter");
  for (const char* to : {"X15 Y0", "X30 Y0", "X30 Y30", "X0 Y30", "X0 Y0"}) {
    drawn.Add(std::string("G1 ") + to + " E.5 F1200");
  }
  const JoinedLayer layer(drawn);
  ASSERT_TRUE(layer.outlines[0].closed);
  const auto stops = [&](uint32_t entry) {
    return StopSeconds(layer.joints.EndOf(0, entry)) + StopSeconds(layer.joints.BeginOf(0, entry));
  };
  EXPECT_NEAR(stops(0), stops(1), 1e-9);
  EXPECT_NEAR(layer.joints.RestartSeconds(0, 2), 0, 1e-6);
  // The corner at its old start slows it down now as it did not before, by 20 - 5 mm/s.
  EXPECT_NEAR(layer.joints.RestartSeconds(0, 1), 2 * 15 * 15 / (2 * 1250.0 * 20), 1e-6);
  EXPECT_EQ(layer.joints.RestartSeconds(0, 0), 0);
}

}  // namespace
}  // namespace traverse::gcode
