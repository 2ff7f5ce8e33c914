// Reads whole files.

#ifndef TRAVERSE_CLIENT_FILES_READ_FILE_H_
#define TRAVERSE_CLIENT_FILES_READ_FILE_H_

#include <cstddef>
#include <string>

#include "absl/status/statusor.h"

namespace traverse {

// Most bytes to read from one file, and to which a compressed one may expand.
inline constexpr size_t kMaxFileBytes = size_t{4} << 30;

// The bytes of the file `name`, decompressed if they are gzip or xz; "-" is standard input.
// Errors begin with the name: `part.damat: No such file or directory`. NotFound, PermissionDenied
// and so on for the file, InvalidArgument for damaged compression, ResourceExhausted beyond
// `max_bytes`.
absl::StatusOr<std::string> ReadWholeFile(const std::string& name,
                                          size_t max_bytes = kMaxFileBytes);

// The name of `name` in messages: "standard input" for "-".
std::string DisplayName(const std::string& name);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_READ_FILE_H_
