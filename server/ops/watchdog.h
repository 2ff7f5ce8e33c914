// Finds workers that do not respond.
//
// Work on a layer asks its budget again and again, and so gives signs of life. A worker that gives
// none for long is stuck: neither cancellation nor deadline will end it, only a new process helps.
// So /healthz fails as long as there is such a worker.

#ifndef TRAVERSE_SERVER_WATCHDOG_H_
#define TRAVERSE_SERVER_WATCHDOG_H_

#include <atomic>
#include <functional>
#include <set>
#include <string>

#include "absl/time/time.h"
#include "server/jobs/worker_pool.h"
#include "server/ops/periodic.h"

namespace traverse {

// Thread-safe.
class Watchdog {
 public:
  // Watches `pool`, which must outlive it. Calls `on_silent` once for each job with a task that has
  // been silent for longer than `limit`.
  Watchdog(WorkerPool& pool, absl::Duration limit,
           std::function<void(const SilentTask&)> on_silent);

  // Workers that are silent now.
  int silent() const { return silent_; }

 private:
  void Look();

  WorkerPool& pool_;
  const absl::Duration limit_;
  const std::function<void(const SilentTask&)> on_silent_;
  std::atomic<int> silent_{0};
  std::set<std::string> reported_;  // jobs
  Periodic looks_;                  // last: uses the others
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_WATCHDOG_H_
