// Lines of progress whose layers saved more, or less, than the rest of the print.
//
// InsertProgressLines (progress_lines.h) keeps each line in its layer, where as large a share of
// that is over as in the file. Where layers differ in what they save, that is not where as large a
// share of the print, with its end script, is over. What then is off by more than a hundredth of
// the print time goes there, whatever layer that is in; what says of a layer which one it is stays
// in it.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_TRUE_PROGRESS_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_TRUE_PROGRESS_H_

#include <optional>
#include <string>
#include <string_view>

#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

// `text`, which prints what `file` does and has its lines of progress in their sequence, with them
// where they are true; unset if they are. O(n): reads the file once and `text` once or twice.
std::optional<std::string> WithTrueProgress(const GcodeFile& file, std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_TRUE_PROGRESS_H_
