// Writes files whole or not at all.

#ifndef TRAVERSE_CLIENT_FILES_WRITE_FILE_H_
#define TRAVERSE_CLIENT_FILES_WRITE_FILE_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace traverse {

// Replaces the content of the file `name` with `bytes`: writes a new file beside it, flushes
// it to disk, and renames it. So a reader sees either the old content or the new, and a
// failure leaves the old. An existing file keeps its permissions (and its owner where the
// system allows it); a symbolic link stays and its target is replaced. Anything but a regular
// file, such as /dev/null or a pipe, is written directly; "-" is standard output. Errors begin
// with the name.
absl::Status WriteWholeFile(const std::string& name, std::string_view bytes);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_WRITE_FILE_H_
