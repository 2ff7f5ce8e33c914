#include "client/files/write_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include "absl/status/statusor.h"
#include "absl/strings/str_format.h"
#include "client/files/file_error.h"

namespace traverse {
namespace {

constexpr mode_t kNewFileMode = 0666;

// 0, or the errno of the write that failed.
int WriteAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t put = write(file, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return errno;
    bytes.remove_prefix(static_cast<size_t>(put));
  }
  return 0;
}

// Where `name` leads through symbolic links, even if the last link's target does not exist yet.
absl::StatusOr<std::filesystem::path> Target(const std::string& name) {
  constexpr int kMaxLinks = 40;
  std::filesystem::path path = name;
  for (int links = 0; links < kMaxLinks; ++links) {
    std::error_code error;
    if (!std::filesystem::is_symlink(path, error)) return path;
    const std::filesystem::path target = std::filesystem::read_symlink(path, error);
    if (error) return FileError(name, error.value());
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return FileError(name, ELOOP);
}

// Opens a new file next to `target` and sets `path` to its name; -1 with errno on failure. It uses
// open() rather than mkstemp() to get the permissions that the process's mask allows.
int OpenBeside(const std::string& target, std::string& path) {
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    path = absl::StrFormat("%s.%d-%d.tmp", target, getpid(), attempt);
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
    if (file >= 0 || errno != EEXIST) return file;
  }
  return -1;
}

// Fills the temporary file and gives it the permissions of `old`. Returns 0 or an errno.
int Fill(int file, std::string_view bytes, const std::optional<struct stat>& old) {
  if (old) {
    // Keeping the owner needs rights that most callers lack; their own files stay theirs anyway.
    if (fchown(file, old->st_uid, old->st_gid) != 0 && errno != EPERM) return errno;
    if (fchmod(file, old->st_mode & 07777) != 0) return errno;
  }
  if (const int error = WriteAll(file, bytes); error != 0) return error;
  return fsync(file) == 0 ? 0 : errno;
}

absl::Status WriteDirectly(const std::string& name, int file, std::string_view bytes) {
  const int error = WriteAll(file, bytes);
  return error == 0 ? absl::OkStatus() : FileError(name, error);
}

}  // namespace

absl::Status WriteWholeFile(const std::string& name, std::string_view bytes) {
  if (name == "-") return WriteDirectly("standard output", STDOUT_FILENO, bytes);
  const absl::StatusOr<std::filesystem::path> target = Target(name);
  if (!target.ok()) return target.status();

  std::optional<struct stat> old;
  if (struct stat info{}; stat(target->c_str(), &info) == 0) old = info;
  if (old && S_ISDIR(old->st_mode)) return FileError(name, EISDIR);
  if (old && !S_ISREG(old->st_mode)) {
    const int file = open(target->c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) return FileError(name, errno);
    const absl::Status status = WriteDirectly(name, file, bytes);
    close(file);
    return status;
  }
  // Does not use the folder to replace a file that the caller may not write.
  if (old && access(target->c_str(), W_OK) != 0) return FileError(name, errno);

  std::string temporary;
  const int file = OpenBeside(target->string(), temporary);
  if (file < 0) return FileError(name, errno);
  int error = Fill(file, bytes, old);
  if (close(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), target->c_str()) != 0) error = errno;
  if (error == 0) return absl::OkStatus();
  unlink(temporary.c_str());
  return FileError(name, error);
}

}  // namespace traverse
