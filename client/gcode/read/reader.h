// Reads sliced G-code: finds the paths and what is between them. See gcode_file.h.

#ifndef TRAVERSE_CLIENT_GCODE_READ_READER_H_
#define TRAVERSE_CLIENT_GCODE_READ_READER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/gcode/model/gcode_file.h"

namespace traverse {

// Takes the G-code `text` apart; `name` is for messages. O(length of the text), one pass.
//
// InvalidArgument with the place (`part.gcode:118: G2 without I, J or R`) for what no machine could
// run, for NUL bytes, and for a text without any extruding move. Anything else that is not
// understood is no error: it becomes a fence.
absl::StatusOr<std::shared_ptr<GcodeFile>> ReadGcode(std::string text, const std::string& name);

namespace gcode {

// Whether both were read as counting E in the same way. A file that has neither M82 nor M83 is
// taken by its words, so that the same lines in another order may be taken otherwise.
bool CountAlike(const GcodeFile& a, const GcodeFile& b);

}  // namespace gcode
}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_READ_READER_H_
