#include "client/gcode/link/link_meter.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>

#include "client/gcode/machine/motion_planner.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

constexpr double kSpeed = 100;
constexpr Decimal kFeed = 6000 * kDecimalOne;  // 100 mm/s
constexpr Decimal kZ = kDecimalOne / 5;

// Of a print at 20 mm/s, with 1250 mm/s^2 and the 5 mm/s of a file that states none: a line along x
// up to (10, 0), and one from (30, 0) on, towards `x`.
class MeteredLink {
 public:
  explicit MeteredLink(double x)
      : file_(Sketch()
                  .Add("M204 S500")
                  .Add("M204 S1250")
                  .Infill(10, 0)
                  .Go(30, 0)
                  .Infill(x, 0)
                  .Read()),
        from_(*file_, PlacedPath(*file_, {0, 0, false})),
        to_(*file_, PlacedPath(*file_, {1, 0, false})) {}

  double Seconds(const NewLink& link) const { return LinkSeconds(*file_, from_, at(), link, to_); }

  double OfTravel() const {
    NewLink link(at());
    link.Travel("G1\n", At(30), kFeed);
    return Seconds(link);
  }

  MachineState at() const { return StartBehind(*file_, file_->blocks[0]).machine; }

  static Position At(int mm) { return {mm * kDecimalOne, 0, kZ}; }

 private:
  const std::shared_ptr<GcodeFile> file_;
  const PathEnds from_;
  const PathEnds to_;
};

// What a path loses that begins or ends at a standstill.
constexpr double kStop = 20 / (2 * 1250.0);

constexpr double kOn = 60;
constexpr double kBack = 0;

TEST(LinkSeconds, StraightOnSaveTheStopsOfBothPaths) {
  // From 20 mm/s up to 100 and down again.
  const double ramps_mm = (kSpeed * kSpeed - 20 * 20) / 1250;
  const double moving = 2 * (kSpeed - 20) / 1250 + (20 - ramps_mm) / kSpeed;

  EXPECT_NEAR(MeteredLink(kOn).OfTravel(), moving - 2 * kStop, 1e-9);
}

TEST(LinkSeconds, TurningBackLoseTime) {
  const double moving = MeteredLink(kOn).OfTravel();
  const double back = MeteredLink(kBack).OfTravel();

  EXPECT_GT(back, moving + .012);
  EXPECT_LT(back, StopToStopSeconds(20, kSpeed, 1250));
}

TEST(LinkSeconds, WithARetractionAreThoseFromStandstillToStandstill) {
  const MeteredLink metered(kOn);
  const auto retracted = [&metered](Decimal inwards) {
    NewLink link(metered.at());
    const Position at = link.at();
    if (inwards > 0) link.Travel("G1\n", {at.x + inwards, 0, kZ}, kFeed);
    link.Pull(kDecimalOne, 2100 * kDecimalOne);
    link.Lift(kZ + kDecimalOne, 600 * kDecimalOne);
    link.Travel("G1\n", {30 * kDecimalOne, 0, kZ + kDecimalOne}, kFeed);
    link.Lift(kZ, 600 * kDecimalOne);
    link.Pull(-kDecimalOne, 2100 * kDecimalOne);
    return metered.Seconds(link);
  };
  const double travel = StopToStopSeconds(20, kSpeed, 1250);

  const double at_once = retracted(0);
  EXPECT_GT(at_once, travel + 2 * (1 / 35. + .1));
  EXPECT_LT(at_once, travel + 2 * (1 / 35. + .1) + .1);
  // Straight on the path is left at 20 mm/s, which end with the move inwards.
  const double behind = retracted(kDecimalOne * 4 / 10);
  EXPECT_LT(behind, at_once + StopToStopSeconds(.4, kSpeed, 1250) - kStop / 2);
}

// What is set counts from there on, and what is set already changes nothing.
TEST(LinkSeconds, CountAccelerationsAsTheyAreSet) {
  const MeteredLink metered(kBack);
  const auto set = [&metered](const char* line) {
    NewLink link(metered.at());
    link.SetBy(line, SlotMask{1} << kSlotPrintAccel | SlotMask{1} << kSlotTravelAccel);
    link.Travel("G1\n", MeteredLink::At(30), kFeed);
    return metered.Seconds(link);
  };

  EXPECT_NEAR(set("M204 S1250\n"), metered.OfTravel(), 1e-9);
  EXPECT_GT(set("M204 S500\n"), metered.OfTravel() + .05);
}

// A loop stops where it begins. At the middle of a side it did not before, but at its corners it
// has to slow down.
TEST(PathEnds, ALoopBegunAtACornerIsPrintedSooner) {
  Sketch drawn;
  drawn.Add(";TYPE:External perimeter");
  for (const char* to : {"X15 Y0", "X30 Y0", "X30 Y30", "X0 Y30", "X0 Y0"}) {
    drawn.Add(std::string("G1 ") + to + " E.5 F1200");
  }
  const auto file = drawn.Read();
  const auto seconds = [&file](uint32_t entry) {
    return PathEnds(*file, PlacedPath(*file, {0, entry, true})).seconds();
  };

  EXPECT_NEAR(seconds(2), seconds(0), 1e-6);
  // The corner at its old start slows it down now, by 20 - 5 mm/s.
  EXPECT_NEAR(seconds(1), seconds(0) + 2 * 15 * 15 / (2 * 1250.0 * 20), 1e-6);
}

}  // namespace
}  // namespace traverse::gcode
