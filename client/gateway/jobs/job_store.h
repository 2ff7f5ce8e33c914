// The jobs of this gateway: under way, and kept until they expire.
//
// A buffer of one process, not a queue: what it holds ends with it. Who sends a file again with the
// same key, anywhere, loses nothing but time.

#ifndef TRAVERSE_CLIENT_GATEWAY_JOBS_JOB_STORE_H_
#define TRAVERSE_CLIENT_GATEWAY_JOBS_JOB_STORE_H_

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/gateway/jobs/job.h"
#include "client/gateway/jobs/job_ids.h"
#include "client/gateway/spool/shares.h"
#include "client/gateway/work/work_queue.h"
#include "engine/base/mutex.h"
#include "server/ops/periodic.h"

namespace traverse::gateway {

struct Core;

struct JobLimits {
  std::string gateway_name = "gateway";
  absl::Duration ttl = absl::Hours(1);  // from a job's end on
  uint64_t max_jobs = 1024;             // under way and kept; for the shares of callers see Shares
};

// Thread-safe.
class JobStore {
 public:
  // Unavailable if there are no ids to be had. `core` outlives it.
  static absl::StatusOr<std::unique_ptr<JobStore>> Make(const JobLimits& limits, Core& core);

  // A job of its own for `wish`, which begins to wait for a worker with `ticket`; or the one that
  // its caller has already made with this key. AlreadyExists if that is for another file or other
  // options; ResourceExhausted if there are too many jobs.
  absl::StatusOr<std::shared_ptr<Job>> Create(const std::shared_ptr<WorkQueue::Ticket>& ticket,
                                              JobWish wish);

  // The job `id` of `caller`. Errors: see JobIds::Check; Aborted too if it is no longer kept.
  absl::StatusOr<std::shared_ptr<Job>> Find(const std::string& id, const std::string& caller) const;

  // Ends it and forgets it. Errors as above.
  absl::Status Cancel(const std::string& id, const std::string& caller);

  // The same for all.
  void CancelAll();

  int kept() const { return static_cast<int>(shares_.used()); }
  int unfetched() const;  // kept ones that their callers do not have

 private:
  JobStore(JobIds ids, const JobLimits& limits, Core& core);

  using Key = std::pair<std::string, std::string>;  // caller, key

  // The job of that caller and key, if it is kept.
  std::shared_ptr<Job> Same(const JobWish& wish) const TRAVERSE_REQUIRES(mutex_);
  absl::StatusOr<std::shared_ptr<Job>> Add(JobWish wish) TRAVERSE_REQUIRES(mutex_);
  void Forget(const Job& job) TRAVERSE_REQUIRES(mutex_);

  // `may`: as of Core::Submit.
  void Run(Job& job, const absl::Status& may);
  void Sweep();

  const JobIds ids_;
  const JobLimits limits_;
  Core& core_;
  Shares shares_;
  mutable Mutex mutex_;
  std::map<std::string, std::shared_ptr<Job>> jobs_ TRAVERSE_GUARDED_BY(mutex_);  // by id
  std::map<Key, std::shared_ptr<Job>> keys_ TRAVERSE_GUARDED_BY(mutex_);
  int sweeps_ = 0;
  Periodic sweep_;  // last: uses the other members
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_JOBS_JOB_STORE_H_
