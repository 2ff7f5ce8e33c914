// Where the lines of the log go: a file that can be reopened, or stderr.

#ifndef TRAVERSE_SERVER_OPS_LOG_FILE_H_
#define TRAVERSE_SERVER_OPS_LOG_FILE_H_

#include <spdlog/sinks/base_sink.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

namespace traverse {

// Thread-safe.
class LogFile : public spdlog::sinks::base_sink<std::mutex> {
 public:
  // Appends to `path`; empty: to stderr. Throws spdlog::spdlog_ex if it cannot be opened.
  explicit LogFile(const std::string& path);
  ~LogFile() override;

  // Opens the path again, because somebody has moved the file. Returns false if that fails; the
  // open file then stays in use.
  bool Reopen();

  // From a second later on, lines for which there is no room within a moment are lost, and all that
  // follow: a pipe whose reader stands still must not keep the process.
  void End() { end_ = Clock::now() + std::chrono::seconds(1); }

  // Lines that could not be written, for example because the disk is full.
  uint64_t lost() const { return lost_; }

 private:
  using Clock = std::chrono::steady_clock;

  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}  // nothing is kept back

  // Waits until PIPE_BUF bytes can be written at once. Returns false at the end.
  bool WaitForRoom();

  // Writes all of `text`, or returns how much of it could be.
  size_t WriteAll(std::string_view text);

  const std::string path_;
  int fd_;
  bool within_line_ = false;  // the last output was part of a line
  bool given_up_ = false;     // the end has come with nobody taking lines
  std::atomic<Clock::time_point> end_{Clock::time_point::max()};
  std::atomic<uint64_t> lost_{0};
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_LOG_FILE_H_
