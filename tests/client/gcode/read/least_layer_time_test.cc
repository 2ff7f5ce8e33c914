// What files state about the least time of a layer, as the reader and the verifier find it apart.

#include "client/gcode/read/least_layer_time.h"

#include <gtest/gtest.h>

#include <string>

#include "client/gcode/verify/match/stated_settings.h"

namespace traverse::gcode {
namespace {

// As both find it; -1 if they do not agree.
double Stated(const std::string& text) {
  const double read = LeastLayerSeconds(text);
  const auto found = ReadStatedSettings(text).least_layer_seconds;
  return found.value_or(kUsualLeastLayerSeconds) == read ? read : -1;
}

TEST(LeastLayerTime, IsReadInTheWordsOfManySlicers) {
  EXPECT_EQ(Stated("G1 X1\n; fan_below_layer_time = 60\n; slowdown_below_layer_time = 5\n"), 5);
  EXPECT_EQ(Stated("; slowdown_below_layer_time = 5,8,6\r\n"), 8);
  EXPECT_EQ(Stated("; fan_cooling_layer_time = 100\n; slow_down_layer_time = 4,4\n"), 4);
  EXPECT_EQ(Stated("; min_layer_time_s = 12.5\n"), 12.5);
  EXPECT_EQ(Stated("; enable_min_layer_time : \tFalse\n; min_layer_time_sec : \t3\n"), 3);
  EXPECT_EQ(Stated(";   minSpeedLayerTime,20\n;   minFanLayerTime,30\n"), 20);
  EXPECT_EQ(Stated("; Minimum layer time: 7\n"), 7);
}

TEST(LeastLayerTime, IsFoundWhereCuraCutsItsSettingsAmidAWord) {
  EXPECT_EQ(
      Stated(";SETTING_3 {\"global_quality\": \"[values]\\\\ncool_fan_speed = 80\\\\ncool_m\n"
             ";SETTING_3 in_layer_time = 6\\\\ncool_min_layer_time_fan_speed_max = 20\\\\n\"}\n"),
      6);
}

TEST(LeastLayerTime, IsTenSecondsWhereNoneIsStated) {
  EXPECT_EQ(Stated(""), 10);
  EXPECT_EQ(Stated("; layer 3, Z = .6\n;LAYER:4\nmin_layer_time = 3\n"), 10);
  EXPECT_EQ(Stated("; slowdown_below_layer_time = \n; min_layer_time_method : \tTower\n"), 10);
}

TEST(LeastLayerTime, MayBeNone) { EXPECT_EQ(Stated("; slowdown_below_layer_time = 0\n"), 0); }

}  // namespace
}  // namespace traverse::gcode
