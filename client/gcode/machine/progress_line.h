// Lines that say how far the print is: they mean something only in the file's order, at their time.
//
//   M73 P33 R15             M117 33%                  ;TIME_ELAPSED:1203.5
//   M117 Layer 12/220       M118 Time left 1h 2m 3s   ;PRINTING_TIME: 1203
//   M532 X33.1 L12          SET_DISPLAY_TEXT MSG="33 %"    ; layer num/total_layer_count: 12/220

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_PROGRESS_LINE_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_PROGRESS_LINE_H_

#include <string_view>

namespace traverse::gcode {

// A comment, with its semicolon, whose key names elapsed, remaining or printing time, progress or
// the number of the layer, and whose value is a number.
bool IsProgressComment(std::string_view comment);

// What is shown on a display or sent to a host: a share in per cent, a number of a total, or a time
// that is left, remains or is elapsed.
bool IsProgressMessage(std::string_view message);

// A macro of Klipper that shows such a message.
bool IsProgressMacro(std::string_view line);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_PROGRESS_LINE_H_
