// Lines that say of which object the next paths are, as slicers, printers and hosts know them: a
// printer may be told to leave an object out, with everything between its labels.

#ifndef TRAVERSE_CLIENT_GCODE_DIALECT_LABEL_H_
#define TRAVERSE_CLIENT_GCODE_DIALECT_LABEL_H_

#include <cstdint>
#include <string_view>

namespace traverse::gcode {

enum class LabelKind : uint8_t {
  kNone,    // no label
  kBegins,  // what follows is of the object that the line names
  kEnds,    // of none; or only no longer of the object that the line names
  kSays,    // an object's name, or how many there are
};

struct Label {
  LabelKind kind = LabelKind::kNone;
  std::string_view notation;  // what lines of its sort begin with: they belong together
  bool named = false;         // it names an object
};

// By the marks of the dialects; besides Marlin's and RepRapFirmware's M486, and what OctoPrint's
// plugins read: `@OBJECT`, `@EXCLUDEREGION`. `line` has no blanks around it.
Label LabelOf(std::string_view line);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_DIALECT_LABEL_H_
