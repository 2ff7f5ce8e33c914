// Lines of our own, and what is known of the machine behind them.

#include "client/gcode/write/gcode_out.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

LinkStep Alone(StepKind kind, Decimal feed) {
  LinkStep step;
  step.kind = kind;
  step.to.z = step.filament = kDecimalOne;
  step.feed = feed;
  return step;
}

// A feed rate is written where it is not in force yet, whatever the line before was there for.
TEST(GcodeOut, WritesAFeedRateOnce) {
  const auto file = Sketch().Square(0, 0, 10).GoRetracted(30, 5).Infill(31, 5).Read();
  const Decimal slow = 1234 * kDecimalOne;
  const Decimal fast = 4321 * kDecimalOne;
  std::string text;
  GcodeOut out(*file, StartBehind(*file, file->blocks[0]), text);
  const auto written = [&] { return std::exchange(text, {}); };

  out.Stand(Alone(StepKind::kFilament, slow));
  EXPECT_NE(written().find("F1234"), std::string::npos);
  out.Stand(Alone(StepKind::kFilament, slow));
  EXPECT_EQ(written().find('F'), std::string::npos);
  out.Stand(Alone(StepKind::kLift, slow));
  EXPECT_EQ(written().find('F'), std::string::npos);
  out.Stand(Alone(StepKind::kLift, fast));
  EXPECT_NE(written().find("F4321"), std::string::npos);
  out.Stand(Alone(StepKind::kFilament, fast));
  EXPECT_EQ(written().find('F'), std::string::npos);
  out.Stand(Alone(StepKind::kFeed, slow));
  EXPECT_EQ(written(), "G1 F1234\n");
  out.Stand(Alone(StepKind::kFilament, slow));
  EXPECT_EQ(written().find('F'), std::string::npos);
}

// Nothing comes between a retraction and the wait beside it, wherever the one ends what is copied.
TEST(GcodeOut, SetsNothingBetweenARetractionAndItsWait) {
  const auto file = Sketch()
                        .Add("M204 S500")
                        .Square(0, 0, 10)
                        .Add("M204 S800")
                        .GoRetracted(30, 5)
                        .Infill(31, 5)
                        .Read();
  LinkLine wait;
  wait.form = LineForm::kEdited;
  wait.raw = "M400\n";
  wait.step.kind = StepKind::kDwell;
  const auto written = [&](Decimal retracted) {
    PartStart start = StartBehind(*file, file->blocks[0]);
    start.machine.retracted = retracted;
    std::string text;
    GcodeOut out(*file, start, text);
    out.Set(file->states[file->blocks[1].state_in], kDynamicsSlots);
    out.Edited(wait);
    out.Stand(Alone(StepKind::kFilament, start.machine.feed));
    return text.substr(0, text.find("G1"));
  };

  EXPECT_EQ(written(kDecimalOne), "M400\nM204 S800\n") << "it waits for what is pulled back";
  EXPECT_EQ(written(0), "M204 S800\nM400\n") << "it waits before it pulls back";
}

}  // namespace
}  // namespace traverse::gcode
