// The settings that CuraEngine's front end appends to a file.
//
//   ;SETTING_3 {"global_quality": "[general]\\nversion = 4\\n...[values]\\ncool_min_layer_ti
//   ;SETTING_3 me = 6\\n..."}

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_CURA_SETTINGS_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_CURA_SETTINGS_H_

#include <string>
#include <string_view>

namespace traverse::gcode {

// All of them without what divides them into lines of the file; empty if there are none.
std::string JoinedCuraSettings(std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_CURA_SETTINGS_H_
