// What holds while something is printed: client/gcode/machine/print_state.h.

#include "client/gcode/machine/print_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::gcode {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr SlotMask kPrint = SlotBit(kSlotPrintAccel);
constexpr SlotMask kBoth = SlotBit(kSlotPrintAccel) | SlotBit(kSlotTravelAccel);

// M204 P500 before M204 P4000 T4000 would have to be said again behind it.
TEST(SettersBetween, WritesThoseOfSeveralSlotsFirst) {
  SetterTable setters;
  const uint32_t print = setters.Intern("M204 P500", kPrint);
  const uint32_t both = setters.Intern("M204 P4000 T4000", kBoth);
  const uint32_t other = setters.Intern("M204 P900 T900", kBoth);
  PrintState from{};
  ApplySetter(from, other, kBoth);
  PrintState to{};
  ApplySetter(to, both, kBoth);
  ApplySetter(to, print, kPrint);

  EXPECT_THAT(SettersBetween(from, to, kBoth, setters), ElementsAre(both, print));
  EXPECT_EQ(from, to);
  EXPECT_THAT(SettersBetween(from, to, kBoth, setters), IsEmpty());
}

}  // namespace
}  // namespace traverse::gcode
