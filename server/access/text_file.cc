#include "server/access/text_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace traverse {
namespace {

constexpr size_t kMaxBytes = size_t{4} << 20;

struct File {
  int fd;
  ~File() {
    if (fd >= 0) close(fd);
  }
};

absl::Status SystemError() { return absl::InvalidArgumentError(std::strerror(errno)); }

}  // namespace

absl::StatusOr<std::string> ReadTextFile(const std::string& path) {
  // A named pipe is not waited for.
  const File file{open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  if (file.fd < 0) return SystemError();
  struct stat info {};
  if (fstat(file.fd, &info) != 0) return SystemError();
  if (S_ISDIR(info.st_mode)) return absl::InvalidArgumentError("it is a directory");
  std::string text;
  char block[16 << 10];
  while (true) {
    const ssize_t count = read(file.fd, block, sizeof(block));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return SystemError();
    if (count == 0) return text;
    text.append(block, static_cast<size_t>(count));
    if (text.size() > kMaxBytes) return absl::InvalidArgumentError("it has more than 4 MiB");
  }
}

FileState StateOfFile(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return {};
  return {int64_t{info.st_mtim.tv_sec} * 1'000'000'000 + info.st_mtim.tv_nsec, info.st_size,
          info.st_ino};
}

}  // namespace traverse
