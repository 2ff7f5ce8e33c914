// When filament is pulled back, and when travel is led around walls: as the file does it.

#include "client/gcode/plan/travel_rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "client/gcode/gcode_job.h"
#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/rewrite.h"
#include "client/gcode/write/layer_writer.h"
#include "client/input/input_job.h"
#include "tests/client/gcode/support/sketch.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

// Two islands of 40 mm with infill. Travel moves inside an island are as long as the one between
// them.
Sketch TwoIslands(bool retracts_inside) {
  Sketch sketch;
  for (const double x : {0.0, 60.0}) {
    if (x > 0) sketch.GoRetracted(x, 0);
    sketch.Square(x, 0, 40);
    for (int line = 1; line <= 6; ++line) {
      const double at = x + 5 * line;
      retracts_inside ? sketch.GoRetracted(at, 5) : sketch.Go(at, 5);
      sketch.Infill(at, 35);
    }
  }
  return sketch;
}

// Retracted travel moves inside too, but for a short open one that shows how those are written.
Sketch TwoIslandsWithOneOpenTravel() { return TwoIslands(true).Go(65, 34).Infill(70, 34); }

struct Rules {
  explicit Rules(std::shared_ptr<GcodeFile> read, bool spares_walls = false)
      : file(std::move(read)),
        habit(LearnRetraction(*file)),
        outlines(OutlinesOf(*file, file->layers[0])),
        walls(outlines) {
    habit.spares_walls = spares_walls;
  }
  PlannedTravel TravelOf(Point a, Point b) const {
    return TravelRules(*file, file->layers[0], habit, outlines, walls)
        .TravelOf(a, b, Feature::kSparseInfill);
  }
  bool Retracts(Point a, Point b) const { return TravelOf(a, b).retracts; }

  std::shared_ptr<GcodeFile> file;
  RetractionHabit habit;
  std::vector<Outline> outlines;
  VisibleWalls walls;
};

// Fact 15.
TEST(TravelRules, RetractWhereTheFileDoesAndNotByLength) {
  const Rules inside_free(TwoIslands(false).Read());
  const Rules inside_too(TwoIslands(true).Read());

  EXPECT_FALSE(inside_free.Retracts({5, 5}, {35, 35}));
  EXPECT_TRUE(inside_free.Retracts({35, 20}, {65, 20}));
  EXPECT_TRUE(inside_too.Retracts({5, 5}, {35, 35}));
}

TEST(TravelRules, RetractHoweverShortOnlyWhereTheFileShowsNoOpenTravel) {
  const Rules all_retracted(TwoIslands(true).Read());
  const Rules one_open(TwoIslandsWithOneOpenTravel().Read());

  EXPECT_TRUE(all_retracted.Retracts({5, 5}, {5, 5.5}));
  EXPECT_FALSE(one_open.Retracts({5, 5}, {5, 5.5}));
}

TEST(TravelRules, OneOpenTravelOfManyDoesNotSayThatWallsMatter) {
  const Rules nearly_all(TwoIslandsWithOneOpenTravel().Read());

  EXPECT_FALSE(nearly_all.habit.crossing_matters);
  EXPECT_TRUE(nearly_all.Retracts({5, 5}, {35, 35}));
  EXPECT_TRUE(Rules(TwoIslands(false).Read()).habit.crossing_matters);
}

// What a print that was rewritten shows of it.
TEST(TravelRules, ReorderingInsideAnIslandAddsNoRetraction) {
  const auto file = TwoIslands(false).Read();
  LayerOrder order;
  for (const uint32_t block : {0u, 3u, 2u, 1u, 6u, 5u, 4u, 7u, 8u, 9u, 10u, 11u, 12u, 13u}) {
    order.push_back({block, 0, block % 7 == 0});
  }
  const LinkDonors donors(*file);
  const RetractionHabit habit = LearnRetraction(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const PartStart start = StartOfPaths(*file, order.front());
  std::string text;

  writer.WritePaths(order, start, text);

  EXPECT_EQ(Measure(*file, text, start).retractions, 1);
}

TEST(TravelRules, ShortTravelsAcrossWallsAreRetractedIfWallsAreToBeSpared) {
  const Rules usual(TwoIslandsWithOneOpenTravel().Read());
  const Rules sparing(TwoIslandsWithOneOpenTravel().Read(), true);

  EXPECT_FALSE(usual.Retracts({39.5, 20}, {40.6, 20}));
  EXPECT_TRUE(sparing.Retracts({39.5, 20}, {40.6, 20}));
  EXPECT_FALSE(sparing.Retracts({30, 20}, {31.1, 20}));
}

TEST(TravelRules, TravelsMuchLongerThanAllOpenOnesAreRetracted) {
  Sketch short_travels;
  short_travels.Infill(10, 0).Go(10, 10).Infill(20, 10).GoRetracted(50, 10).Infill(60, 10);
  Rules rules(TwoIslands(false).Read());

  EXPECT_NEAR(LearnRetraction(*short_travels.Read()).longest_open_mm, 19.95, 1e-3);
  rules.habit.longest_open_mm = 19.95;
  EXPECT_TRUE(rules.Retracts({5, 5}, {5, 26}));
  EXPECT_FALSE(rules.Retracts({5, 5}, {5, 24}));
}

TEST(TravelRules, TravelsThatNoDetourSparesAWallAreRetractedWhereOthersLeadAround) {
  const Rules avoiding(TwoIslands(false).Add("; avoid_crossing_perimeters = 1").Read());

  ASSERT_TRUE(avoiding.habit.avoids_walls);
  EXPECT_TRUE(avoiding.Retracts({35, 20}, {65, 20}));
  EXPECT_FALSE(avoiding.Retracts({5, 5}, {35, 35}));
}

TEST(MeasureLayers, CountsTravelsAcrossVisibleWalls) {
  Sketch sketch = TwoIslands(false);
  sketch.Go(5, 37).Infill(35, 37);

  const PrintTotals totals = Sum(MeasureLayers(*sketch.Read()));

  EXPECT_EQ(totals.crossings, 2);
  EXPECT_EQ(totals.open_crossings, 1);
}

// An island with a hole, and infill on all sides of it. As sliced, the head goes round.
Sketch Ring(const std::string& setting) {
  Sketch sketch;
  sketch.Square(0, 0, 40).Go(15, 15).Square(15, 15, 10);
  sketch.Go(15, 5).Infill(25, 5).Go(35, 15).Infill(35, 25).Go(25, 35).Infill(15, 35);
  sketch.Go(5, 25).Infill(5, 15).Go(35, 2).Infill(39, 2);
  return sketch.Add(setting);
}

// The first and third stretch of infill change places, so that the head has to pass the hole.
const LayerOrder kPastTheHole = {{0, 0, true},  {1, 0, true},  {4, 0, false}, {2, 0, false},
                                 {3, 0, false}, {5, 0, false}, {6, 0, false}};

PrintTotals RingPastTheHole(const std::string& setting) {
  const auto file = Ring(setting).Read();
  const LinkDonors donors(*file);
  const RetractionHabit habit = LearnRetraction(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const PartStart start = StartOfPaths(*file, kPastTheHole.front());
  std::string text;
  writer.WritePaths(kPastTheHole, start, text);
  return Measure(*file, text, start, &writer.walls());
}

// Slicers' own open travel never passes over a visible wall: it keeps away from the walls beside
// which it neither begins nor ends.
TEST(TravelRules, RetractWhereTheyPassOverAVisibleWallThatTheyDoNotCross) {
  const Rules ring(Ring("").GoRetracted(2, 2).Infill(2, 38).Read());

  // Past the corner of the hole at 15, 15: by 0.07 mm, and by 0.7.
  EXPECT_TRUE(ring.Retracts({10, 19.9}, {19.9, 10}));
  EXPECT_TRUE(ring.Retracts({19.9, 10}, {10, 19.9}));
  EXPECT_FALSE(ring.Retracts({10, 19}, {19, 10}));
  // Along it, from the end of a line beside it to the next one.
  EXPECT_FALSE(ring.Retracts({14.9, 16}, {14.9, 24}));
  // From the wall itself.
  EXPECT_FALSE(ring.Retracts({15, 20}, {5, 20}));
}

// Fact 16.
TEST(TravelRules, NewTravelGoesAroundWallsWhereTheFileDoes) {
  const PrintTotals avoiding = RingPastTheHole("; avoid_crossing_perimeters = 1");
  const PrintTotals straight = RingPastTheHole("; avoid_crossing_perimeters = 0");

  EXPECT_EQ(avoiding.crossings, 0);
  EXPECT_GT(straight.crossings, 0);
  EXPECT_GT(avoiding.travel_mm, straight.travel_mm);
}

// Past the hole is shorter than around it.
Sketch AroundTheHole() {
  Sketch sketch;
  sketch.Square(0, 0, 40).GoRetracted(15, 15).Square(15, 15, 10).GoRetracted(5, 18).Infill(5, 22);
  sketch.GoRetracted(35, 37).Infill(39, 37).GoRetracted(35, 18).Infill(35, 22);
  return sketch;
}

TEST(RewriteGcode, CrossesNoMoreWallsUnlessAskedTo) {
  const auto file = AroundTheHole().Read();
  const LayerOrder past = {{0, 0, true}, {1, 0, true}, {2, 0, false}, {4, 0, false}, {3, 0, false}};
  RewriteOptions options;
  options.policy = Policy::kFree;

  const auto keep = RewriteGcode(*file, {past}, options);
  options.crossings = Crossings::kAny;
  const auto any = RewriteGcode(*file, {past}, options);

  ASSERT_TRUE(keep.ok() && any.ok());
  EXPECT_EQ(keep->layers_changed, 0);
  EXPECT_EQ(any->layers_changed, 1);
  EXPECT_GT(any->after.crossings, any->before.crossings);
}

// The search is told the walls, and the rule by which ways are written.
TEST(MakeGcodeJob, TellsTheSearchOfWallsAndRetractions) {
  const InputJob job = MakeGcodeJob(TwoIslands(false).Read(), {});

  const v1::Layer& layer = job.layers[0];
  ASSERT_EQ(layer.walls_size(), 2);
  EXPECT_EQ(layer.walls(0).path(), 0u);
  EXPECT_EQ(layer.walls(1).path(), 7u);
  EXPECT_TRUE(layer.walls(0).closed());
  EXPECT_GE(layer.walls(0).points_size(), 8);
  EXPECT_EQ(layer.exposed_paths_size(), 0);
  const v1::TimeCost& time = layer.cost().time();
  EXPECT_GT(time.retraction_seconds(), 0);
  EXPECT_GT(time.retraction_threshold_mm(), 40);
  EXPECT_LT(time.retraction_threshold_mm(), 100);
  EXPECT_EQ(time.wall_retraction_threshold_mm(), 0);
  EXPECT_EQ(time.crossing_seconds(), kKeepCrossingSeconds);
}

// Four lines, of which the first so many are wiped.
InputJob WipedLines(int wiped, const GcodeOptions& options = {}) {
  Sketch sketch;
  for (int line = 0; line < 4; ++line) {
    if (line > 0) sketch.Add("G1 E-.4 F2100");
    if (line > 0 && line <= wiped) {
      sketch.Add("G1 X5 Y" + std::to_string(10 * line - 10) + " E-.4 F7200");
    } else if (line > 0) {
      sketch.Add("G1 E-.4 F2100");
    }
    sketch.Go(0, 10 * line);
    if (line > 0) sketch.Add("G1 E.8 F2100");
    sketch.Infill(10, 10 * line);
  }
  return MakeGcodeJob(sketch.Read(), options);
}

// What is wiped is retracted whatever follows it, so that no order saves that. (Half a minute of
// computing went into 1,421 retractions of ps_grille_klipper_wipe, and none was saved.)
TEST(MakeGcodeJob, RetractionsBehindWipedPathsAreNothingToSave) {
  const v1::Layer layer = WipedLines(1).layers[0];

  ASSERT_EQ(layer.retracted_paths_size(), 1);
  EXPECT_EQ(layer.retracted_paths(0), 0u);
  EXPECT_EQ(layer.exposed_paths_size(), 4);
  EXPECT_GT(layer.cost().time().retraction_threshold_mm(), 1000);
  EXPECT_LT(layer.cost().time().exposed_retraction_threshold_mm(), 20);
  EXPECT_EQ(WipedLines(0).layers[0].exposed_paths_size(), 0);
  EXPECT_LT(WipedLines(0).layers[0].cost().time().retraction_threshold_mm(), 20);
}

TEST(MakeGcodeJob, RetractionsBehindWipedPathsAreSavedWhereWipesAreLeftOut) {
  GcodeOptions options;
  options.allow.wipes = true;
  const v1::Layer layer = WipedLines(2, options).layers[0];

  EXPECT_EQ(layer.retracted_paths_size(), 0);
  EXPECT_LT(layer.cost().time().retraction_threshold_mm(), 20);
  ASSERT_EQ(layer.known_moves_size(), 3);
  EXPECT_NEAR(layer.known_moves(0).seconds(), layer.known_moves(2).seconds(), 1e-9);
}

// As new travel moves are: half of a retraction at either end.
TEST(MakeGcodeJob, TravelsOfTheFileFromWipedPathsAreToldWithoutTheirRetraction) {
  const v1::Layer layer = WipedLines(2).layers[0];

  ASSERT_EQ(layer.known_moves_size(), 3);
  const double retraction = layer.cost().time().retraction_seconds();
  EXPECT_GT(retraction, 0);
  const double between_wiped = layer.known_moves(0).seconds();
  EXPECT_NEAR(layer.known_moves(1).seconds(), between_wiped + retraction / 2, 1e-9);
  EXPECT_NEAR(layer.known_moves(2).seconds(), between_wiped + retraction, 1e-9);
  for (const v1::KnownMove& move : layer.known_moves()) EXPECT_TRUE(move.retracts());
}

// New travel moves across walls are retracted, those of the file often are not: who is not told so
// finds retractions to save where there are none.
TEST(MakeGcodeJob, TellsTheSearchWhatTheTravelsOfTheFileTake) {
  Sketch sketch = TwoIslands(false);
  sketch.Go(5, 37).Infill(35, 37);  // across the walls of both islands
  const InputJob job = MakeGcodeJob(sketch.Read(), {});

  const v1::Layer& layer = job.layers[0];
  ASSERT_EQ(layer.known_moves_size(), 14);
  const v1::KnownMove& retracted = layer.known_moves(6);
  EXPECT_EQ(retracted.from(), 6u);
  EXPECT_EQ(retracted.to(), 7u);
  EXPECT_TRUE(retracted.crosses());
  EXPECT_TRUE(retracted.retracts());
  const v1::KnownMove& open = layer.known_moves(13);
  EXPECT_TRUE(open.crosses());
  EXPECT_FALSE(open.retracts());
  EXPECT_GT(retracted.seconds(), layer.cost().time().retraction_seconds());
  EXPECT_NEAR(open.seconds(), std::hypot(85, 2) / layer.cost().time().speed_mm_s(), 0.2);
}

// CuraEngine's travel moves have bends of its own, longer than a travel move of ours would be.
TEST(MakeGcodeJob, TellsTheSearchOfBendsThatTheFileHas) {
  Sketch sketch = AroundTheHole().Add("; avoid_crossing_perimeters = 1");
  sketch.Go(1, 37).Go(1, 1).Infill(5, 1);
  const v1::Layer layer = MakeGcodeJob(sketch.Read(), {}).layers[0];

  const v1::KnownMove& last = layer.known_moves(layer.known_moves_size() - 1);
  const double speed = layer.cost().time().speed_mm_s();
  EXPECT_GT(last.seconds(), (std::hypot(34, 15) + 36) / speed);
  EXPECT_FALSE(last.crosses());
}

// Whatever comes before them. (ps_gear_train_avoid_100 was told 33 s to save, and 97 s were.)
TEST(MakeGcodeJob, TellsTheSearchOfBendsBehindAShortMove) {
  Sketch sketch = AroundTheHole().Add("; avoid_crossing_perimeters = 1");
  sketch.Go(35, 21.5).Go(1, 37).Go(1, 1).Infill(5, 1);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_NE(file->blocks.back().link & kLinkDeparts, 0);
  const v1::Layer layer = MakeGcodeJob(file, {}).layers[0];

  const v1::KnownMove& last = layer.known_moves(layer.known_moves_size() - 1);
  const v1::TimeCost& time = layer.cost().time();
  const double length = std::hypot(34, 15.5) + 36;
  EXPECT_GT(last.seconds(), StopToStopSeconds(length, time.speed_mm_s(), time.accel_mm_s2()));
}

// (With one, sl_clusters13_brim took 3.7 s of computing in place of 0.9 s, and was as quick to
// print.)
TEST(MakeGcodeJob, AsksForNoBound) {
  EXPECT_EQ(WipedLines(0).options.strategy().options().at("bound"), "false");
}

TEST(RewriteGcode, UnderSafeNoMoreTravelsCrossWallsWithAnOpenNozzle) {
  const auto file = Ring("; avoid_crossing_perimeters = 0").Read();
  const absl::StatusOr<GcodeRewrite> rewrite = RewriteGcode(*file, {kPastTheHole}, {});

  ASSERT_TRUE(rewrite.ok()) << rewrite.status();
  EXPECT_LE(rewrite->after.open_crossings, rewrite->before.open_crossings);
}

TEST(TravelRules, AWayAroundAWallIsAsLongAsItsBends) {
  const Rules avoiding(AroundTheHole().Add("; avoid_crossing_perimeters = 1").Read());
  ASSERT_TRUE(avoiding.habit.avoids_walls);

  const PlannedTravel past = avoiding.TravelOf({5, 10}, {35, 10});
  EXPECT_FALSE(past.crosses);
  EXPECT_NEAR(past.mm, 30, 1e-9);
  // From 5, 20 to a corner of the hole at 15, 15, along it to 25, 15, and to 35, 20.
  const PlannedTravel around = avoiding.TravelOf({5, 20}, {35, 20});
  EXPECT_FALSE(around.crosses);
  EXPECT_NEAR(around.mm, 10 + 2 * std::hypot(10, 5), 2);
}

// The bend beside the corner at 40, 40 would lie within a square that hardly leaves room for it, so
// that there is no travel around.
TEST(TravelRules, TravelsWithABendWithinAnotherWallAreRetracted) {
  Sketch sketch = TwoIslands(false).GoRetracted(40.3, 40.3).Square(40.3, 40.3, 10);
  const auto file = sketch.Add("; avoid_crossing_perimeters = 1").Read();
  const Rules sparing(file, true);
  ASSERT_TRUE(sparing.habit.avoids_walls);

  const PlannedTravel narrow = sparing.TravelOf({42, 35}, {35, 42});
  EXPECT_TRUE(narrow.via.empty());
  EXPECT_TRUE(narrow.crosses);
  EXPECT_TRUE(narrow.retracts);
  const PlannedTravel wide = sparing.TravelOf({-2, 35}, {5, 42});
  EXPECT_FALSE(wide.via.empty());
  EXPECT_FALSE(wide.crosses);
  EXPECT_FALSE(wide.retracts);
}

}  // namespace
}  // namespace traverse::gcode
