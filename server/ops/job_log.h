// The log: one line of JSON for each job and for each event of the server's life.
//
//   {"time":"2026-08-01T12:00:00.123Z","level":"info","event":"job","job_id":"plate-7",...}
//
// Thread-safe. Lines are written by a thread of their own; where the reader of the log is slower
// than the server, the oldest lines are dropped rather than jobs held up.

#ifndef TRAVERSE_SERVER_OPS_JOB_LOG_H_
#define TRAVERSE_SERVER_OPS_JOB_LOG_H_

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"

namespace spdlog {
class logger;
namespace details {
class thread_pool;
}
}  // namespace spdlog

namespace traverse {

class LogFile;

// What is said about a job when it has ended.
struct JobRecord {
  std::string job_id;
  std::string method;    // of the service
  std::string caller;    // who it is counted for
  std::string peer;      // address, as gRPC writes it
  std::string trace_id;  // of the traceparent that came with the call; empty if none did
  std::string strategy;
  uint64_t layers_received = 0;
  uint64_t layers = 0;  // answered
  int64_t points = 0;
  double queue_seconds = 0;    // until the first worker took it up
  double compute_seconds = 0;  // of work, over all threads
  double wall_seconds = 0;
  double travel_given_mm = 0;
  double travel_mm = 0;
  double idle_seconds_saved = 0;
  uint64_t invalid_routes = 0;
  absl::Status status;
};

class JobLog {
 public:
  enum class Level { kInfo, kWarning, kError };

  // Key and value as they appear, the value escaped as a JSON string.
  using Fields = std::vector<std::pair<std::string, std::string>>;

  // A log that writes nothing.
  JobLog() = default;
  ~JobLog();

  // A log to `path`, which is appended to; empty for stderr. Throws spdlog::spdlog_ex if the file
  // cannot be opened.
  explicit JobLog(const std::string& path);

  void Job(const JobRecord& record);
  void Event(Level level, const std::string& event, const Fields& fields);

  // Opens the file anew, for somebody has moved it away. False if that cannot be done.
  bool Reopen();

  // Lines dropped because the log could not keep up, or could not be written.
  uint64_t lost_lines() const;

 private:
  void Write(Level level, const std::string& line);

  std::shared_ptr<spdlog::details::thread_pool> writer_;
  std::shared_ptr<LogFile> file_;
  std::shared_ptr<spdlog::logger> logger_;
};

// One line without the line break.
std::string FormatJobLine(const JobRecord& record);

// `text` as a JSON string, with its quotes. Invalid UTF-8 is replaced; control characters, those of
// a terminal among them, are escaped.
std::string JsonString(const std::string& text);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_JOB_LOG_H_
