#include "server/ops/log_file.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>

namespace traverse {
namespace {

constexpr mode_t kMode = 0644;

int OpenToAppend(const std::string& path) {
  return open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, kMode);
}

// How often to look whether the end has come.
constexpr int kLookMilliseconds = 50;

}  // namespace

LogFile::LogFile(const std::string& path)
    : path_(path), fd_(path.empty() ? STDERR_FILENO : OpenToAppend(path)) {
  if (fd_ < 0) throw spdlog::spdlog_ex("cannot open the log file " + path, errno);
}

LogFile::~LogFile() {
  if (!path_.empty()) close(fd_);
}

bool LogFile::Reopen() {
  if (path_.empty()) return true;
  const int fd = OpenToAppend(path_);
  if (fd < 0) return false;
  std::lock_guard<std::mutex> lock(mutex_);
  close(fd_);
  fd_ = fd;
  within_line_ = false;
  return true;
}

bool LogFile::WaitForRoom() {
  pollfd polled{fd_, POLLOUT, 0};
  while (!given_up_ && poll(&polled, 1, kLookMilliseconds) <= 0) {
    given_up_ = Clock::now() >= end_.load();
  }
  return !given_up_;
}

size_t LogFile::WriteAll(std::string_view text) {
  size_t done = 0;
  while (done < text.size() && WaitForRoom()) {
    const size_t part = std::min<size_t>(text.size() - done, PIPE_BUF);
    const ssize_t count = write(fd_, text.data() + done, part);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<size_t>(count);
  }
  return done;
}

void LogFile::sink_it_(const spdlog::details::log_msg& message) {
  spdlog::memory_buf_t line;
  if (within_line_) line.push_back('\n');
  formatter_->format(message, line);
  const size_t written = WriteAll({line.data(), line.size()});
  if (written == line.size()) {
    within_line_ = false;
    return;
  }
  if (written > 0) within_line_ = true;
  ++lost_;
}

}  // namespace traverse
