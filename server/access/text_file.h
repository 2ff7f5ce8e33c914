// Small files of text that an operator gives: tokens, certificates.

#ifndef TRAVERSE_SERVER_ACCESS_TEXT_FILE_H_
#define TRAVERSE_SERVER_ACCESS_TEXT_FILE_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"

namespace traverse {

// The content of a file of at most 4 MiB. Errors: InvalidArgument, with why alone (`it is a
// directory`): the caller says which file it is.
absl::StatusOr<std::string> ReadTextFile(const std::string& path);

// Tells whether a file has changed.
struct FileState {
  int64_t modified_ns = 0;
  int64_t size = -1;
  uint64_t inode = 0;
  friend bool operator==(const FileState&, const FileState&) = default;
};

// The state of a file now; that of a missing one is FileState().
FileState StateOfFile(const std::string& path);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_ACCESS_TEXT_FILE_H_
