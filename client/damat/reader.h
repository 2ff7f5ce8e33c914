// Reads DAMAT (format.h). One pass, time linear in the text.

#ifndef TRAVERSE_CLIENT_DAMAT_READER_H_
#define TRAVERSE_CLIENT_DAMAT_READER_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/input/input_job.h"

namespace traverse {

// The job in `text`: layers of islands. InvalidArgument with name and line for the first fault:
// `part.damat:118: X12.5 without Y`. Degenerate geometry is valid: contours of one vertex, repeated
// vertices, rasters of length zero, islands without rasters or contours, layers without islands.
absl::StatusOr<InputJob> ReadDamat(std::string_view text, const std::string& name);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_DAMAT_READER_H_
