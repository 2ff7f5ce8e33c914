// Custom G-code: lines that a setting of the slicer adds, such as `before_layer_gcode`.
// PrusaSlicer, OrcaSlicer, Bambu Studio and their kin state it in comments: "; layer_gcode =
// M400\nM117 [layer_num]".

#ifndef TRAVERSE_CLIENT_GCODE_READ_CUSTOM_GCODE_H_
#define TRAVERSE_CLIENT_GCODE_READ_CUSTOM_GCODE_H_

#include <optional>
#include <string_view>
#include <vector>

namespace traverse::gcode {

// The settings that add lines between paths, not at the start or end of the print, and have `line`,
// such as "M400 ; wait"; if none has all of it, those that have its command. Nothing if `text`
// states no custom G-code, or the line is a comment.
std::optional<std::vector<std::string_view>> SettingsThatAdd(std::string_view text,
                                                             std::string_view line);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_READ_CUSTOM_GCODE_H_
