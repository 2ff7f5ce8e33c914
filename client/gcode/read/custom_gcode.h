// Custom G-code: lines that a setting of the slicer adds, such as `before_layer_gcode`.
// PrusaSlicer, OrcaSlicer, Bambu Studio and their kin state it in comments: "; layer_gcode =
// M400\nM117 [layer_num]".

#ifndef TRAVERSE_CLIENT_GCODE_READ_CUSTOM_GCODE_H_
#define TRAVERSE_CLIENT_GCODE_READ_CUSTOM_GCODE_H_

#include <optional>
#include <string_view>

namespace traverse::gcode {

// The first setting that adds lines between paths, not at the start or end of the print, and has
// `command`, such as "M400"; empty if none has it; nothing if `text` states no custom G-code, or
// the command is none, as of a comment.
std::optional<std::string_view> SettingThatAdds(std::string_view text, std::string_view command);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_READ_CUSTOM_GCODE_H_
