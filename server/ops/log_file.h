// Where the lines of the log go: a file that can be reopened, or stderr.

#ifndef TRAVERSE_SERVER_OPS_LOG_FILE_H_
#define TRAVERSE_SERVER_OPS_LOG_FILE_H_

#include <spdlog/sinks/base_sink.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

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

  // Lines that could not be written, for example because the disk is full.
  uint64_t lost() const { return lost_; }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}  // nothing is kept back

  const std::string path_;
  int fd_;
  bool within_line_ = false;  // the last output was part of a line
  std::atomic<uint64_t> lost_{0};
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_LOG_FILE_H_
