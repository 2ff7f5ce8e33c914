// Lines of our own, and what is known of the machine behind them.

#include "client/gcode/write/gcode_out.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

// A feed rate is written where it is not in force yet, whatever the line before was there for.
TEST(GcodeOut, WritesAFeedRateOnce) {
  const auto file = Sketch().Square(0, 0, 10).GoRetracted(30, 5).Infill(31, 5).Read();
  const Decimal one = kDecimalOne;
  const Decimal slow = 1234 * kDecimalOne;
  const Decimal fast = 4321 * kDecimalOne;
  std::string text;
  GcodeOut out(*file, StartBehind(*file, file->blocks[0]), text);
  const auto written = [&] { return std::exchange(text, {}); };

  out.Pull(one, slow);
  EXPECT_NE(written().find("F1234"), std::string::npos);
  out.Pull(one, slow);
  EXPECT_EQ(written().find('F'), std::string::npos);
  out.Lift(one, slow);
  EXPECT_EQ(written().find('F'), std::string::npos);
  out.Lift(one, fast);
  EXPECT_NE(written().find("F4321"), std::string::npos);
  out.Pull(one, fast);
  EXPECT_EQ(written().find('F'), std::string::npos);
  out.Feed(slow);
  EXPECT_EQ(written(), "G1 F1234\n");
  out.Pull(one, slow);
  EXPECT_EQ(written().find('F'), std::string::npos);
}

// Nothing comes between a retraction and the wait behind it, wherever the one ends what is copied.
TEST(GcodeOut, WaitsBeforeItSets) {
  const auto file = Sketch()
                        .Add("M204 S500")
                        .Square(0, 0, 10)
                        .Add("M204 S800")
                        .GoRetracted(30, 5)
                        .Infill(31, 5)
                        .Read();
  std::string text;
  GcodeOut out(*file, StartBehind(*file, file->blocks[0]), text);
  LinkLine wait;
  wait.form = LineForm::kEdited;
  wait.raw = "M400\n";
  wait.step.kind = StepKind::kDwell;

  out.Set(file->states[file->blocks[1].state_in], kDynamicsSlots);
  out.Edited(wait);
  EXPECT_EQ(text, "M400\n");
  out.Flush();
  EXPECT_EQ(text, "M400\nM204 S800\n");
}

}  // namespace
}  // namespace traverse::gcode
