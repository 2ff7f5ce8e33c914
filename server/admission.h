// Who may come in: limits on jobs and on queued work.
//
// Work is counted in points: the time and the memory that a layer takes grow with them, a request's
// or a layer's do not. A job is refused as a whole and at once, before any work; what was let in is
// done. Streams that were let in are held back, not refused, while the queue is full.
//
// A job is also refused if it would take much longer than alone. Workers take turns, so that a job
// of p points is done when each other job of its caller has had p points of work or has ended, and
// each other caller as much as this one. Small jobs are therefore let in beside large ones that
// would themselves have to wait; under overload the large ones are refused first.
//
// Knows nothing of gRPC.

#ifndef TRAVERSE_SERVER_ADMISSION_H_
#define TRAVERSE_SERVER_ADMISSION_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace traverse {

struct AdmissionLimits {
  int max_jobs = 256;                     // in flight
  int max_jobs_per_caller = 64;           // in flight
  int64_t max_queued_points = 8'000'000;  // of all jobs together, not yet solved
  int64_t max_queued_points_per_caller = 4'000'000;

  // A job is refused that is expected to take longer than `max_wait` and longer than `max_slowdown`
  // times what it would take alone.
  absl::Duration max_wait = absl::Milliseconds(250);
  double max_slowdown = 3;

  int workers = 1;
};

// Why a job was refused; the label of a metric.
enum class Refusal {
  kDraining,
  kJobs,
  kCallerJobs,
  kQueue,
  kCallerQueue,
  kWait,
  kMessage,
  kJobLayers,
  kJobPoints,
  kLayerPoints,
  kUnauthenticated,
  kPermission,
};
const char* RefusalName(Refusal refusal);

// Thread-safe.
class Admission {
 public:
  class Ticket;

 private:
  // A caller with jobs in flight.
  struct Caller {
    std::set<const Ticket*> jobs;
    int64_t queued_points = 0;
  };

 public:
  // The place of one job; leaves when it is destroyed. Thread-safe. Outlived by the Admission.
  class Ticket {
   public:
    ~Ticket();
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

    // The job turned out to have `points`, none of which it brought yet. Errors: as of Admit, if
    // they are more than was said then; the job is to end.
    absl::Status Resize(int64_t points);

    // Counts `points` more as queued, whether there is room or not.
    void Add(int64_t points);

    // `points` are solved, which took a worker `seconds`.
    void Remove(int64_t points, double seconds);

    // False if the queue, or the caller's part of it, is full and this job has its share of it:
    // then the job should bring no more until some of its own is solved.
    bool MayBringMore() const;

   private:
    friend class Admission;
    explicit Ticket(Admission& admission) : admission_(admission) {}

    // REQUIRES: admission_.mutex_ is held.
    void Count(int64_t points);

    // Guarded by admission_.mutex_.
    Admission& admission_;
    std::map<std::string, Caller>::iterator caller_;
    int64_t points_ = 0;
  };

  // `on_refusal` is called for each refusal, from any thread.
  Admission(const AdmissionLimits& limits, std::function<void(Refusal)> on_refusal);

  // Lets a job of `caller` in that is about to queue `points`. Errors: Unavailable while draining;
  // ResourceExhausted with a retry delay (server/retry_delay.h) if a limit is
  // reached. A job is let into an empty queue whatever its size.
  absl::StatusOr<std::unique_ptr<Ticket>> Admit(const std::string& caller, int64_t points);

  // Counts a refusal that was decided elsewhere.
  void CountRefusal(Refusal refusal) { on_refusal_(refusal); }

  // From now on no job is let in.
  void StartDraining();
  bool draining() const;

  int jobs() const;
  int64_t queued_points() const;

 private:
  // Why the job may not come in; nothing if it may. REQUIRES: mutex_ is held.
  struct No {
    Refusal refusal;
    absl::Status status;
  };
  std::optional<No> Check(const std::string& caller, int64_t points) const;
  std::optional<No> CheckPoints(const std::string& caller, int64_t points) const;
  std::optional<No> CheckQueues(const std::string& caller, int64_t points) const;
  std::optional<No> CheckWait(const std::string& caller, int64_t points) const;

  // Points that are solved before a new job is done, its own included. REQUIRES: mutex_ is held.
  int64_t PointsUntilDone(const std::string& caller, int64_t points) const;

  // Time until `points` are solved, at the rate of late; zero while that is unknown.
  // REQUIRES: mutex_ is held.
  absl::Duration TimeFor(int64_t points) const;

  const AdmissionLimits limits_;
  const std::function<void(Refusal)> on_refusal_;
  mutable std::mutex mutex_;
  bool draining_ = false;
  int jobs_ = 0;
  int64_t queued_points_ = 0;
  std::map<std::string, Caller> callers_;  // those with jobs

  // Of layers solved of late: sums whose older parts count ever less.
  double solved_points_ = 0;
  double solved_seconds_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_ADMISSION_H_
