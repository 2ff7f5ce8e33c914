// What a line tells of the progress of the print, by the verifier's own reading.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_TOLD_PROGRESS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_TOLD_PROGRESS_H_

#include <string_view>

namespace traverse::gcode {

// A comment `; KEY: NUMBER` or `; KEY = NUMBER` that tells elapsed, remaining or printing time,
// progress, or of how many layers this is one.
bool CommentTellsProgress(std::string_view line);

// M117, M118, or a macro that shows a text: the text has a number with `%`, two numbers with `/` or
// `of` between them, or a number and the word left, remain, remaining or elapsed.
bool MessageTellsProgress(std::string_view line);

// The per cent that `line` tells; less than 0 if it tells none: `M73 P33 R15`, with Q instead for
// another mode of the machine; `M532 X33`; `M117 33%`.
double PercentTold(std::string_view line);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_TOLD_PROGRESS_H_
