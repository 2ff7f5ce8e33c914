#include "client/gcode/read/custom_gcode.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

TEST(SettingThatAdds, IsTheOneThatHasTheCommand) {
  const char* const text =
      "G1 X5\n; machine_start_gcode = M400\\nG28\n; layer_gcode = ;L\\nM117 [layer_num]\n"
      "; time_lapse_gcode = {if a}\\nM400 ; wait\\nM9711 S1\\n{endif}\n";
  EXPECT_EQ(SettingThatAdds(text, "M400"), "time_lapse_gcode");
  EXPECT_EQ(SettingThatAdds(text, "M117"), "layer_gcode");
  EXPECT_EQ(SettingThatAdds(text, "M971"), "");
  EXPECT_EQ(SettingThatAdds(text, "G28"), "");
}

TEST(SettingThatAdds, IsUnknownWhereNoneIsStated) {
  EXPECT_EQ(SettingThatAdds("G1 X5\n", "M400"), std::nullopt);
  EXPECT_EQ(SettingThatAdds("M117 my_gcode = M400\n; gcode_comments = 0\n", "M400"), std::nullopt);
  EXPECT_EQ(SettingThatAdds("; layer_gcode = M400", "M400"), "layer_gcode");
  EXPECT_EQ(SettingThatAdds("; layer_gcode = ;M400", ""), std::nullopt);
}

TEST(SettingThatAdds, TakesNoLongerEachInALongLine) {
  const auto look = [](int times) {
    std::string text = ";";
    for (int i = 0; i < times; ++i) text += "_gcode = ";
    EXPECT_EQ(SettingThatAdds(text, "M400"), "");
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(20'000, look), traverse::testing::kSlowGrowth);
}

}  // namespace
}  // namespace traverse::gcode
