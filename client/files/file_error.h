// The messages of file errors.

#ifndef TRAVERSE_CLIENT_FILES_FILE_ERROR_H_
#define TRAVERSE_CLIENT_FILES_FILE_ERROR_H_

#include <string>

#include "absl/status/status.h"

namespace traverse {

// The error of the system call that set `error_number`: `part.damat: No such file or directory`.
absl::Status FileError(const std::string& display_name, int error_number);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_FILE_ERROR_H_
