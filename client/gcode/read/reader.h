// Reads sliced G-code: finds the paths and the text between them. See gcode_file.h.

#ifndef TRAVERSE_CLIENT_GCODE_READ_READER_H_
#define TRAVERSE_CLIENT_GCODE_READ_READER_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/gcode/model/gcode_file.h"

namespace traverse {

// Divides the G-code `text`; `name` is for messages. O(length of the text), one pass.
//
// InvalidArgument with the position (`part.gcode:118: G2 without I, J or R`) for what no machine
// could run, for NUL bytes, and for a text without any extruding move. Anything else that is not
// understood is not an error; nothing crosses it. Cancelled and DeadlineExceeded once `limit` ends,
// which also limits what is then done with the file.
absl::StatusOr<std::shared_ptr<GcodeFile>> ReadGcode(std::string text, const std::string& name,
                                                     const gcode::WorkLimit& limit = {});

namespace gcode {

// Whether both were read with the same counting of E. A file without M82 and M83 is judged by its
// words, so the same lines in another order may be judged differently.
bool CountAlike(const GcodeFile& a, const GcodeFile& b);

}  // namespace gcode
}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_READ_READER_H_
