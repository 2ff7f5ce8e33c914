#include "client/files/read_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/files/decompress.h"
#include "client/files/file_error.h"
#include "client/files/process_memory.h"

namespace traverse {
namespace {

constexpr size_t kFirstBuffer = size_t{1} << 16;

absl::Status Fault(const std::string& name, const absl::Status& status) {
  return absl::Status(status.code(),
                      absl::StrFormat("%s: %s", DisplayName(name), status.message()));
}

// All bytes of an open file. The size that stat states is only a hint, because pipes have none.
absl::StatusOr<std::string> ReadAll(const std::string& name, int file, size_t max_bytes) {
  struct stat info {};
  if (fstat(file, &info) != 0) return FileError(DisplayName(name), errno);
  if (S_ISDIR(info.st_mode)) return FileError(DisplayName(name), EISDIR);
  const size_t hint = info.st_size > 0 ? static_cast<size_t>(info.st_size) + 1 : kFirstBuffer;
  const size_t first = std::min(hint, max_bytes + 1);
  std::string bytes;
  ReserveLarge(bytes, first);
  bytes.resize(first);
  size_t used = 0;
  while (true) {
    if (used == bytes.size()) {
      if (used > max_bytes) break;
      bytes.resize(std::min(used * 2, max_bytes + 1));
    }
    const ssize_t got = read(file, bytes.data() + used, bytes.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return FileError(DisplayName(name), errno);
    if (got == 0) break;
    used += static_cast<size_t>(got);
  }
  if (used > max_bytes) {
    return Fault(
        name, absl::ResourceExhaustedError(absl::StrFormat("longer than %d MiB", max_bytes >> 20)));
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace

std::string DisplayName(const std::string& name) { return name == "-" ? "standard input" : name; }

absl::StatusOr<std::string> ReadWholeFile(const std::string& name, size_t max_bytes) {
  const bool standard_input = name == "-";
  const int file = standard_input ? STDIN_FILENO : open(name.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return FileError(DisplayName(name), errno);
  absl::StatusOr<std::string> bytes = ReadAll(name, file, max_bytes);
  if (!standard_input) close(file);
  if (!bytes.ok()) return bytes;

  const Compression compression = DetectCompression(*bytes);
  if (compression == Compression::kNone) return bytes;
  absl::StatusOr<std::string> plain = Decompress(*bytes, compression, max_bytes);
  if (!plain.ok()) return Fault(name, plain.status());
  return plain;
}

}  // namespace traverse
