// Settings of things that have names or numbers of their own: fans, lights, input shapers.
//
//   SET_FAN_SPEED FAN=aux SPEED=0.5      Klipper: what it sets is told by one of its parameters
//   SET_INPUT_SHAPER SHAPER_FREQ_X=40    and by which of them there are
//   M593 F40 D0.1                        the same of commands and their words
//
// A line sets what has its name, and two lines that set the same are read as one setting.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_NAMED_SETTING_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_NAMED_SETTING_H_

#include <string_view>

#include "client/gcode/machine/print_state.h"
#include "client/gcode/text/lexer.h"

namespace traverse::gcode {

// The slots of a setting; 0 if it is none that is known. Reads the words of commands that may be.
SlotMask NamedTextSlots(std::string_view command, std::string_view parameters);
SlotMask NamedCommandSlots(Command& command);

// The slot of what is called `name`, for settings that are known elsewhere; `first` is the first
// slot of its kind.
SlotMask SlotOfName(std::string_view name, Slot first);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_NAMED_SETTING_H_
