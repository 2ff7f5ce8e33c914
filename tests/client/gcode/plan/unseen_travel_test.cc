// What holds for new travel of a kind that the file has none of.

#include <gtest/gtest.h>

#include "client/gcode/gcode_job.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/plan/travel_rules.h"
#include "client/input/input_job.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

// A square with lines of infill, and with small squares in it that are reached by short ways alone.
// Travel moves inside are retracted or not, those to another square are.
class UnseenTravel : public ::testing::Test {
 protected:
  static std::shared_ptr<GcodeFile> File(bool retracts_inside) {
    testing::Sketch sketch;
    sketch.Square(0, 0, 40);
    for (const double x : {5.0, 10.0, 15.0, 20.0, 25.0}) {
      retracts_inside ? sketch.GoRetracted(x, 5) : sketch.Go(x, 5);
      sketch.Infill(x, 30);
    }
    sketch.Go(26, 30).Add(";TYPE:Perimeter").Add("G1 X28 Y30 E.1 F1200");
    sketch.Add("G1 X28 Y32 E.1").Add("G1 X26 Y30 E.1");
    sketch.GoRetracted(60, 0).Square(60, 0, 40);
    sketch.Go(65, 5).Infill(65, 30).Go(70, 30).Infill(70, 5);
    return sketch.Read();
  }

  static bool Retracts(const GcodeFile& file, Feature feature, Point to) {
    const RetractionHabit habit = HabitOfNewTravels(file);
    EXPECT_TRUE(habit.crossing_matters);
    const std::vector<Outline> outlines = OutlinesOf(file, file.layers[0]);
    const VisibleWalls walls(outlines);
    const TravelRules rules(file, file.layers[0], habit, outlines, walls);
    return rules.TravelOf({5, 30}, to, feature).retracts;
  }
};

// (In sl_brackets24_abs_100 each layer wrote 27 retractions of 75 that the search knew nothing of.)
TEST_F(UnseenTravel, InsideAnIslandIsRetractedAsOtherTravelIs) {
  const auto open = File(false);
  EXPECT_FALSE(Retracts(*open, Feature::kSparseInfill, {26, 30}));
  EXPECT_FALSE(Retracts(*open, Feature::kInnerWall, {26, 30}));
  EXPECT_TRUE(Retracts(*open, Feature::kInnerWall, {65, 30}));  // across walls

  const auto retracted = File(true);
  EXPECT_TRUE(Retracts(*retracted, Feature::kSparseInfill, {26, 30}));
  EXPECT_TRUE(Retracts(*retracted, Feature::kInnerWall, {26, 30}));
}

// Between two parts of a support there need be no wall.
TEST_F(UnseenTravel, ToSupportsIsRetracted) {
  EXPECT_TRUE(Retracts(*File(false), Feature::kSupport, {26, 30}));
}

// One sees where they begin.
TEST_F(UnseenTravel, ToOuterWallsIsRetracted) {
  EXPECT_TRUE(Retracts(*File(false), Feature::kOuterWall, {26, 30}));
}

// So that it counts what is written.
TEST_F(UnseenTravel, IsToldTheSearch) {
  // (Of a move to an outer wall it cannot know: one from there would retract for it, too.)
  const v1::Layer open = MakeGcodeJob(File(false), {}).layers[0];
  const v1::Layer retracted = MakeGcodeJob(File(true), {}).layers[0];

  EXPECT_EQ(open.exposed_paths_size(), 0);
  EXPECT_EQ(retracted.exposed_paths_size(), retracted.plan().paths_size() - 2);
}

}  // namespace
}  // namespace traverse::gcode
