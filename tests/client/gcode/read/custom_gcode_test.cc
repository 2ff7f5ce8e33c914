#include "client/gcode/read/custom_gcode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Optional;

TEST(SettingsThatAdd, HaveTheCommand) {
  const char* const text =
      "G1 X5\n; machine_start_gcode = M400\\nG28\n; layer_gcode = ;L\\nM117 [layer_num]\n"
      "; time_lapse_gcode = {if a}\\nM400 ; wait\\nM9711 S1\\n{endif}\n";
  EXPECT_THAT(SettingsThatAdd(text, "M400"), Optional(ElementsAre("time_lapse_gcode")));
  EXPECT_THAT(SettingsThatAdd(text, "M117"), Optional(ElementsAre("layer_gcode")));
  EXPECT_THAT(SettingsThatAdd(text, "M971"), Optional(IsEmpty()));
  EXPECT_THAT(SettingsThatAdd(text, "G28"), Optional(IsEmpty()));
}

TEST(SettingsThatAdd, IsUnknownWhereNoneIsStated) {
  EXPECT_EQ(SettingsThatAdd("G1 X5\n", "M400"), std::nullopt);
  EXPECT_EQ(SettingsThatAdd("M117 my_gcode = M400\n; gcode_comments = 0\n", "M400"), std::nullopt);
  EXPECT_THAT(SettingsThatAdd("; layer_gcode = M400", "M400"),
              Optional(ElementsAre("layer_gcode")));
  EXPECT_EQ(SettingsThatAdd("; layer_gcode = ;M400", ""), std::nullopt);
}

TEST(SettingsThatAdd, HaveTheWholeLineIfAnyHas) {
  const char* const text =
      "; layer_gcode = M400 P1\\nG4\n; pause_gcode = M400 ; wait\n; time_lapse_gcode = M400 ; "
      "wait\n";
  EXPECT_THAT(SettingsThatAdd(text, "M400 ; wait"),
              Optional(ElementsAre("pause_gcode", "time_lapse_gcode")));
  EXPECT_THAT(SettingsThatAdd(text, "M400 P1"), Optional(ElementsAre("layer_gcode")));
  EXPECT_THAT(SettingsThatAdd(text, "M400 P2"),
              Optional(ElementsAre("layer_gcode", "pause_gcode", "time_lapse_gcode")));
}

TEST(SettingsThatAdd, TakesNoLongerEachInALongLine) {
  const auto look = [](int times) {
    std::string text = ";";
    for (int i = 0; i < times; ++i) text += "_gcode = ";
    EXPECT_THAT(SettingsThatAdd(text, "M400"), Optional(IsEmpty()));
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(20'000, look), traverse::testing::kSlowGrowth);
}

}  // namespace
}  // namespace traverse::gcode
