// The least layer time among the settings that a slicer writes into its file.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_STATED_LAYER_TIME_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_STATED_LAYER_TIME_H_

#include <optional>
#include <string_view>

namespace traverse::gcode {

// In seconds; the greatest one if there are several. Unset if no comment of `text` states one.
std::optional<double> StatedLeastLayerSeconds(std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_STATED_LAYER_TIME_H_
