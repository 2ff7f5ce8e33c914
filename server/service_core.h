// What all calls of the service share: pool, admission, metrics, log, limits, the running jobs.

#ifndef TRAVERSE_SERVER_SERVICE_CORE_H_
#define TRAVERSE_SERVER_SERVICE_CORE_H_

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "engine/base/mutex.h"
#include "server/jobs/admission.h"
#include "server/jobs/job_run.h"
#include "server/jobs/return_lag.h"
#include "server/jobs/worker_pool.h"
#include "server/net/connections.h"
#include "server/net/memory_watch.h"
#include "server/ops/metrics/metrics.h"
#include "server/ops/operator_files.h"
#include "server/ops/periodic.h"
#include "server/ops/watchdog.h"

namespace traverse {

// Limits on one message or job. They protect memory; admission.h has the limits on jobs.
struct JobLimits {
  int64_t max_message_bytes = int64_t{64} << 20;
  int64_t max_bytes_per_message = INT64_MAX;  // that its layers need once they are read
  int64_t max_layers_per_message = 100'000;
  int64_t max_layers_per_job = 0;  // 0: no limit
  int64_t max_points_per_job = 0;  // 0: no limit
  int64_t max_points_per_layer = 1'000'000;
  JobWindow window;

  // A job ends if its caller neither sends nor reads anything for this long.
  absl::Duration idle_timeout = absl::Minutes(5);
};

struct ServiceOptions {
  int threads = 1;
  absl::Duration watchdog = absl::InfiniteDuration();  // silence of a worker that counts as a fault
  int worker_nice = 0;                                 // added to the workers' nice value
  JobLimits limits;
  AdmissionLimits admission;
  std::map<std::string, double> caller_weights;  // shares of the workers' time; others have 1
  AuthOptions auth;
  std::string log_path;  // empty: stderr
  bool log = true;
};

// Thread-safe.
class ServiceCore {
 public:
  // Throws what the constructor of JobLog throws.
  explicit ServiceCore(const ServiceOptions& options);

  // The calls whose jobs were admitted, until gRPC is done with them. `cancel` ends a call without
  // waiting for its reader. It may be called later than that.
  void Register(const std::shared_ptr<JobRun>& run, const std::string& peer,
                std::function<void()> cancel);
  void Unregister(const std::shared_ptr<JobRun>& run, const std::string& peer);

  // Begins to watch memory, and reports to `connections`, which may be null and must outlive their
  // calls. `max_memory`: what the process may use, in bytes.
  void Watch(Connections* connections, int64_t max_memory);

  // Passed on to Connections.
  void OnCall(const std::string& peer);
  void OnCallDone(const std::string& peer);
  void OnAuthorized(const std::string& peer);
  void OnMessage(const std::string& peer, int64_t bytes);

  // Ends the oldest job of `peer` (see PeerKey) whose message is still incomplete, because it is
  // larger than any may be. Returns false if there is none.
  bool EndOversizeJob(const std::string& peer, Excess excess);
  size_t calls() const;

  // Ends all running jobs with `status`.
  void AbortAll(const absl::Status& status);

  // Ends the running jobs whose callers do nothing, and ended calls whose last messages nobody
  // reads.
  void AbortStalled();

  // Ends the job whose caller has done nothing for longest, if that was a while: all places are
  // taken, and somebody has none.
  void GiveWay();

  // Returns memory that the allocator keeps to the system, once no job has run for some seconds.
  // One thread must call it regularly. Returns whether it did so now.
  bool TrimIfIdle(std::chrono::steady_clock::time_point now);

  // Whether all workers respond.
  bool healthy() const { return !watchdog_ || watchdog_->silent() == 0; }

  // The text of /metrics.
  std::string MetricsText();

  const JobLimits limits;
  Metrics metrics;
  OperatorFiles files;
  Admission admission;
  std::atomic<int64_t> queue_layers{0};  // accepted but not yet solved
  ReturnLag return_lag;
  WakeLateness wake_lateness;

 private:
  // A call, and its origin.
  struct Call {
    std::shared_ptr<JobRun> run;
    std::function<void()> cancel;
    std::string peer;           // see PeerKey
    double pending_before = 0;  // from Connections::OnJob
  };

  std::vector<Call> Calls() const;

  mutable Mutex mutex_;
  std::map<const JobRun*, Call> runs_ TRAVERSE_GUARDED_BY(mutex_);
  Connections* connections_ = nullptr;
  int64_t max_memory_ = INT64_MAX;
  uint64_t registered_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // number of calls so far

  // What TrimIfIdle last saw.
  uint64_t seen_registered_ = 0;
  bool trimmed_ = true;
  std::chrono::steady_clock::time_point idle_since_{};

 public:
  WorkerPool pool;  // its threads end before anything that its tasks use

 private:
  Periodic wakes_;  // measures wake_lateness
  std::optional<Watchdog> watchdog_;
  std::optional<Periodic> watch_;  // last: calls AbortStalled and TrimIfIdle
  std::optional<MemoryWatch> watch_memory_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_SERVICE_CORE_H_
