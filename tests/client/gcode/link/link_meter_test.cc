#include "client/gcode/link/link_meter.h"

#include <gtest/gtest.h>

#include <memory>

#include "client/gcode/machine/motion_planner.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

constexpr double kTurnBack = -1;
constexpr Joint kJoint = {{1, 0}, 20, 1250};
constexpr Decimal kFeed = 6000 * kDecimalOne;  // 100 mm/s
constexpr Position kEnd = {10 * kDecimalOne, 0, kDecimalOne / 5};

// Behind a line that ends at kEnd.
class MeteredLink {
 public:
  double Seconds(const NewLink& link, double x) const {
    const Joint joint{{x, 0}, kJoint.speed_mm_s, kJoint.accel_mm_s2};
    LinkMeter meter(*file_, start_, joint);
    meter.Follow(link);
    return meter.Finish(joint);
  }

  // Of a travel move of 20 mm along x, joined to paths that lead along (x, 0).
  double OfTravel(double x) const {
    NewLink link = Begun();
    link.Travel("G1\n", At(30), kFeed);
    return Seconds(link, x);
  }

  NewLink Begun() const { return NewLink(start_.machine); }

  static Position At(int mm) { return {mm * kDecimalOne, 0, kEnd.z}; }

 private:
  // With 1250 mm/s^2, and the 5 mm/s of a file that states none.
  const std::shared_ptr<GcodeFile> file_ =
      Sketch().Add("M204 S500").Add("M204 S1250").Infill(10, 0).Read();
  const PartStart start_ = StartBehind(*file_, file_->blocks[0]);
};

TEST(LinkMeter, StraightOnNothingIsLost) {
  // From 20 mm/s up to 100 and down again.
  const double ramps_mm = (100.0 * 100 - 20 * 20) / 1250;

  EXPECT_NEAR(MeteredLink().OfTravel(1), 2 * (100.0 - 20) / 1250 + (20 - ramps_mm) / 100, 1e-9);
}

TEST(LinkMeter, TurningBackLosesNearlyWhatAStopDoes) {
  const double stop = StopToStopSeconds(20, 100, 1250) + 2 * StopSeconds(kJoint);

  EXPECT_LT(MeteredLink().OfTravel(kTurnBack), stop);
  EXPECT_GT(MeteredLink().OfTravel(kTurnBack), stop - .015);
}

TEST(LinkMeter, ARetractionStopsAtBothPaths) {
  const MeteredLink metered;
  const auto retracted = [&metered](Decimal inwards) {
    NewLink link = metered.Begun();
    if (inwards > 0) link.Travel("G1\n", {kEnd.x + inwards, 0, kEnd.z}, kFeed);
    link.Pull(kDecimalOne, 2100 * kDecimalOne);
    link.Lift(kEnd.z + kDecimalOne, 600 * kDecimalOne);
    link.Travel("G1\n", {30 * kDecimalOne, 0, kEnd.z + kDecimalOne}, kFeed);
    link.Lift(kEnd.z, 600 * kDecimalOne);
    link.Pull(-kDecimalOne, 2100 * kDecimalOne);
    return metered.Seconds(link, 1);
  };
  const double travel = StopToStopSeconds(20, 100, 1250) + 2 * StopSeconds(kJoint);

  const double at_once = retracted(0);
  EXPECT_GT(at_once, travel + 2 * (1 / 35. + .1));
  EXPECT_LT(at_once, travel + 2 * (1 / 35. + .1) + .1);
  // Straight on the path is left at 20 mm/s, which end with the move inwards.
  const double behind = retracted(kDecimalOne * 4 / 10);
  EXPECT_GT(behind, at_once);
  EXPECT_LT(behind, at_once + StopToStopSeconds(.4, 100, 1250));
}

// What is set counts from there on, and what is set already changes nothing.
TEST(LinkMeter, AccelerationsCountAsTheyAreSet) {
  const MeteredLink metered;
  const auto set = [&metered](const char* line) {
    NewLink link = metered.Begun();
    link.SetBy(line, SlotMask{1} << kSlotPrintAccel | SlotMask{1} << kSlotTravelAccel);
    link.Travel("G1\n", MeteredLink::At(30), kFeed);
    return metered.Seconds(link, kTurnBack);
  };

  EXPECT_NEAR(set("M204 S1250\n"), metered.OfTravel(kTurnBack), 1e-9);
  EXPECT_GT(set("M204 S500\n"), metered.OfTravel(kTurnBack) + .05);
}

}  // namespace
}  // namespace traverse::gcode
