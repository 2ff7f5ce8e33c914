// Writing files whole or not at all.

#ifndef TRAVERSE_CLIENT_FILES_WRITE_FILE_H_
#define TRAVERSE_CLIENT_FILES_WRITE_FILE_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace traverse {

// Makes `bytes` the content of the file `name`: they are written to a new file beside it, brought
// to the disk, and then take its name in one step, so that a reader sees the old content or the
// new, and a failure leaves the old. A file that is replaced keeps its permissions (and its owner
// where the system allows); a symbolic link stays, its target is replaced. What is not a regular
// file, such as /dev/null or a pipe, is written to directly; "-" is standard output. Errors begin
// with the name.
absl::Status WriteWholeFile(const std::string& name, std::string_view bytes);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_WRITE_FILE_H_
