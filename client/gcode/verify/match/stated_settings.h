// Settings that slicers write into their files under many names, or amid other text.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_STATED_SETTINGS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_STATED_SETTINGS_H_

#include <optional>
#include <string_view>

namespace traverse::gcode {

// Each is unset if no comment states it.
struct StatedSettings {
  std::optional<double> least_layer_seconds;  // the greatest one if there are several
  std::optional<double> filament_mm;          // its diameter; the same of several
  std::optional<double> head_reach_mm;        // of CuraEngine's head polygon around the nozzle
  std::optional<double> head_above_tip_mm;    // how much higher than the tip the head begins
};

// Of all comments of `text`.
StatedSettings ReadStatedSettings(std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_STATED_SETTINGS_H_
