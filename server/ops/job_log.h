// The log: one line of JSON for each job and for each event of the server's life.
//
//   {"time":"2026-08-01T12:00:00.123Z","level":"info","event":"job","job_id":"plate-7",...}
//
// Thread-safe. A separate thread writes the lines. If the log's reader is slower than the server,
// the oldest lines are dropped, so that jobs are not delayed.

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

// What the log says about a job that has ended.
struct JobRecord {
  std::string job_id;
  std::string method;    // of the service
  std::string caller;    // the name under which it is counted
  std::string peer;      // address, as gRPC writes it
  std::string trace_id;  // of the traceparent that came with the call; empty if there was none
  std::string strategy;
  uint64_t layers_received = 0;
  uint64_t layers = 0;  // answered
  int64_t points = 0;
  double queue_seconds = 0;    // until the first worker began it
  double compute_seconds = 0;  // of work, summed over all threads
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

  // Waits until the lines are written, but not long for a reader that stands still.
  ~JobLog();

  // A log that appends to `path`; empty for stderr. Throws spdlog::spdlog_ex if the file cannot be
  // opened.
  explicit JobLog(const std::string& path);

  void Job(const JobRecord& record);
  void Event(Level level, const std::string& event, const Fields& fields);

  // Opens the file again, because somebody has moved it. Returns false if that fails.
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

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_JOB_LOG_H_
