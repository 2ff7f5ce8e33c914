// What a daemon's main function does around its work: signals, open files, exit codes.

#ifndef TRAVERSE_SERVER_OPS_DAEMON_H_
#define TRAVERSE_SERVER_OPS_DAEMON_H_

#include <signal.h>

#include <functional>
#include <string>

#include "absl/status/status.h"
#include "server/ops/job_log.h"

namespace traverse {

// Exit codes.
inline constexpr int kExitStart = 1;
inline constexpr int kExitUsage = 2;

class Daemon {
 public:
  // Create it before any thread. From then on SIGTERM, SIGINT, SIGHUP and `also_ends` (0: none) are
  // seen only where they are waited for, SIGPIPE nowhere. Raises the limit of open files to the
  // highest that the system allows this process. `name` stands before messages on stderr.
  explicit Daemon(std::string name, int also_ends = 0);

  // Prints `status` in one line. Returns kExitUsage for InvalidArgument, else kExitStart.
  int Fail(const absl::Status& status) const;

  // Logs that work begins, on `port`, and `few_files`: of what the limit of open files leaves room
  // for less than flags say, in words; empty: of nothing.
  void LogStart(JobLog& log, int port, const std::string& few_files) const;

  // Waits for a signal that ends the daemon, and returns it. Calls `reload` at each SIGHUP.
  int WaitForEnd(JobLog& log, const std::function<void()>& reload) const;

  // Logs that `signal` came. From now on another one ends the process at once, with 128 plus its
  // number; SIGHUP and the constructor's `also_ends` do not.
  void BeginDraining(int signal, JobLog& log) const;

 private:
  const std::string name_;
  const int also_ends_;
  sigset_t signals_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_DAEMON_H_
