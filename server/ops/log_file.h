// Where the lines of the log go: a file that can be opened anew, or stderr.

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

  // Opens the path anew, for somebody has moved the file away. False if that cannot be done; the
  // one that is open stays then.
  bool Reopen();

  // Lines that could not be written, as where the disk is full.
  uint64_t lost() const { return lost_; }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}  // nothing is kept back

  const std::string path_;
  int fd_;
  bool within_line_ = false;  // what was written last is part of a line
  std::atomic<uint64_t> lost_{0};
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_LOG_FILE_H_
