// Small text files that an operator provides: tokens, certificates.

#ifndef TRAVERSE_SERVER_ACCESS_TEXT_FILE_H_
#define TRAVERSE_SERVER_ACCESS_TEXT_FILE_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"

namespace traverse {

// The content of a file of at most 4 MiB. Errors: InvalidArgument with only the reason (`it is a
// directory`); the caller adds the file's name.
absl::StatusOr<std::string> ReadTextFile(const std::string& path);

// Shows whether a file has changed.
struct FileState {
  int64_t modified_ns = 0;
  int64_t size = -1;
  uint64_t inode = 0;
  friend bool operator==(const FileState&, const FileState&) = default;
};

// The state of a file now; FileState() if it is missing.
FileState StateOfFile(const std::string& path);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_ACCESS_TEXT_FILE_H_
