// What all calls of the service share: pool, admission, metrics, log, limits, the jobs under way.

#ifndef TRAVERSE_SERVER_SERVICE_CORE_H_
#define TRAVERSE_SERVER_SERVICE_CORE_H_

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "server/admission.h"
#include "server/auth.h"
#include "server/job_log.h"
#include "server/job_run.h"
#include "server/metrics.h"
#include "server/periodic.h"
#include "server/return_lag.h"
#include "server/worker_pool.h"

namespace traverse {

// Limits on what one message or job may hold. They protect memory; admission.h has those on jobs.
struct JobLimits {
  int64_t max_message_bytes = int64_t{64} << 20;
  int64_t max_layers_per_message = 100'000;
  int64_t max_layers_per_job = 0;  // 0: no limit
  int64_t max_points_per_job = 0;  // 0: no limit
  int64_t max_points_per_layer = 1'000'000;
  JobWindow window;

  // A job is given up whose caller neither sends nor reads anything for so long.
  absl::Duration idle_timeout = absl::Minutes(5);
};

struct ServiceOptions {
  int threads = 1;
  int worker_nice = 0;  // how much nicer the workers are than the threads of the calls
  JobLimits limits;
  AdmissionLimits admission;
  AuthOptions auth;
  std::string log_path;  // empty: stderr
  bool log = true;
};

// Thread-safe.
class ServiceCore {
 public:
  // Throws what JobLog throws.
  explicit ServiceCore(const ServiceOptions& options);

  // Sets up `auth`; before the first call. Errors as of Authenticator::Make.
  absl::Status StartAuth(const AuthOptions& options);

  // The calls whose jobs were let in, until gRPC is done with them.
  void Register(const std::shared_ptr<JobRun>& run);
  void Unregister(const std::shared_ptr<JobRun>& run);
  size_t calls() const;

  // Ends all jobs under way with `status`.
  void AbortAll(const absl::Status& status);

  // Ends the jobs under way whose callers do nothing.
  void AbortStalled();

  // Gives memory that the allocator keeps back to the system, once no job was under way for some
  // seconds. To be called again and again, by one thread. Returns whether it did so now.
  bool TrimIfIdle(std::chrono::steady_clock::time_point now);

  // The text of /metrics.
  std::string MetricsText();

  const JobLimits limits;
  Metrics metrics;
  std::unique_ptr<JobLog> log;
  Admission admission;
  std::unique_ptr<Authenticator> auth;
  std::atomic<int64_t> queue_layers{0};  // accepted and not yet solved
  ReturnLag return_lag;

 private:
  std::vector<std::shared_ptr<JobRun>> Runs() const;

  mutable std::mutex mutex_;
  std::set<std::shared_ptr<JobRun>> runs_;
  uint64_t registered_ = 0;  // so far

  // Of TrimIfIdle: what it saw.
  uint64_t seen_registered_ = 0;
  bool trimmed_ = true;
  std::chrono::steady_clock::time_point idle_since_{};

 public:
  WorkerPool pool;  // its threads end before anything that tasks use is gone

 private:
  std::optional<Periodic> watch_;  // last: calls AbortStalled and TrimIfIdle
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_SERVICE_CORE_H_
