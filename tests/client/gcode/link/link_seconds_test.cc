// What retractions cost between paths, beside what is written.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/write/layer_writer.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

constexpr int kHeights[] = {0, 70, 10, 60, 20, 50, 30, 40};

// Lines of 10 mm one above the other. The head rises on the way to them by `slope`, and the line at
// `wiped` is wiped; behind that at `slow` the prime is slow, and behind that at `waits` the head
// waits for a second once it has retracted.
std::shared_ptr<GcodeFile> Lines(double slope, int wiped = -1, int slow = -1, int waits = -1) {
  Sketch sketch;
  double x = 0;
  double y = 0;
  for (const int height : kHeights) {
    const double mm = std::hypot(x, height - y);
    if (wiped >= 0 && y == wiped) {
      sketch.Add(";WIPE_START").Add(absl::StrCat("G1 X2 Y", y, " E-.8 F6000")).Add(";WIPE_END");
    } else {
      sketch.Add("G1 E-.8 F2100");
    }
    if (waits >= 0 && y == waits) sketch.Add("G4 P1000");
    const std::string rise = slope > 0 ? absl::StrCat(" Z", .2 + slope * mm) : "";
    sketch.Add(absl::StrCat("G1 X0 Y", height, rise, " F9000"));
    if (slope > 0) sketch.Add("G1 Z.2 F300");
    sketch.Add(slow >= 0 && y == slow ? "G1 E.8 F210" : "G1 E.8 F2100").Infill(10, height);
    x = 10;
    y = height;
  }
  return sketch.Read();
}

// Of the lines from the lowest to the highest, less than in the order of the file.
struct Saved {
  double estimated = 0;
  double written = 0;
};

Saved SavedUpwards(const GcodeFile& file) {
  const RetractionHabit habit = HabitOfNewTravels(file);
  const LinkDonors donors(file);
  const LayerWriter writer(file, file.layers[0], habit, donors);
  const LayerOrder given = writer.GivenOrder();
  LayerOrder upwards = given;
  std::stable_sort(upwards.begin() + 1, upwards.end(), [&file](const auto& a, const auto& b) {
    return file.blocks[a.block].first.y < file.blocks[b.block].first.y;
  });
  Saved saved;
  for (const double sign : {1.0, -1.0}) {
    const LayerOrder& order = sign > 0 ? given : upwards;
    const PartStart start = StartOfPaths(file, order.front());
    std::string text;
    writer.WritePaths(order, start, text);
    saved.written += sign * Measure(file, text, start).seconds;
    for (size_t i = 1; i < order.size(); ++i) {
      saved.estimated += sign * writer.EstimateTravel(i, order[i - 1], order[i]).seconds;
    }
  }
  return saved;
}

// As high as the file's own travel moves from and to the same lines, and higher on longer travel
// moves.
TEST(Retractions, OfASlopeCostTheMoreTheHigherItRises) {
  const auto file = Lines(.02);
  ASSERT_EQ(file->blocks.size(), 8u);

  const Saved saved = SavedUpwards(*file);

  EXPECT_GT(saved.written, 0);
  EXPECT_NEAR(saved.estimated, saved.written, .001);
}

TEST(Retractions, WithoutASlopeCostTheSameEverywhere) {
  const Saved saved = SavedUpwards(*Lines(0));

  EXPECT_GT(saved.written, 0);
  EXPECT_NEAR(saved.estimated, saved.written, .001);
}

// Nothing in the layer is behind the highest line if it comes last.
TEST(Retractions, CostWhatTheWipeOfThePathBeforeDoes) {
  const Saved saved = SavedUpwards(*Lines(0, 70));
  const Saved unwiped = SavedUpwards(*Lines(0));

  EXPECT_GT(saved.written, unwiped.written + .05);
  EXPECT_NEAR(saved.estimated, saved.written, .001);
}

// However it is come to, a path is primed as in the file: behind the highest line slowly.
TEST(Retractions, CostWhatThePrimeOfThePathBehindDoes) {
  const Saved saved = SavedUpwards(*Lines(0, -1, 70));
  const Saved alike = SavedUpwards(*Lines(0));

  EXPECT_NEAR(saved.written, alike.written, .005);
  EXPECT_NEAR(saved.estimated, saved.written, .001);
}

// Nothing in the layer is behind the highest line if it comes last.
TEST(Retractions, CostWhatTheHeadWaitsForBehindThem) {
  const Saved saved = SavedUpwards(*Lines(0, -1, -1, 70));
  const Saved hasty = SavedUpwards(*Lines(0));

  EXPECT_NEAR(saved.written, hasty.written + 1, .05);
  EXPECT_NEAR(saved.estimated, saved.written, .001);
}

}  // namespace
}  // namespace traverse::gcode
