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

#ifndef TRAVERSE_SERVER_JOBS_ADMISSION_H_
#define TRAVERSE_SERVER_JOBS_ADMISSION_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "engine/base/mutex.h"

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

  // Memory that jobs make the server hold: what their messages are counted to come to, and answers.
  int64_t max_bytes = INT64_MAX;
  int64_t max_bytes_per_caller = INT64_MAX;
};

// Why a job was refused; the label of a metric.
enum class Refusal {
  kDraining,
  kJobs,
  kCallerJobs,
  kQueue,
  kCallerQueue,
  kWait,
  kMemory,
  kCallerMemory,
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
    int64_t bytes = 0;
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

    // A layer of `points`, for which `bytes` were held, is solved, which took a worker `seconds`.
    void Remove(int64_t points, int64_t bytes, double seconds);

    // The job makes the server hold `bytes` more, or less. Errors: ResourceExhausted, as of Admit,
    // if the memory for jobs is taken; then nothing is counted.
    absl::Status Hold(int64_t bytes);
    void LetGo(int64_t bytes);

    // The same for answers, which are there whether there is room or not: those that wait for a
    // slow reader take the place of what would be let in.
    void KeepAnswer(int64_t bytes);
    void LetGoAnswer(int64_t bytes);

    // The job is done by `strategy`: from now on its time is known better. Errors: as of Admit.
    absl::Status SetStrategy(const std::string& strategy);

    // Asks whether workers have something to do for the job, with a lock held. While they have not,
    // for its caller does not read or send, its points are no load for others.
    void WatchWork(std::function<bool()> is_worked_on);

    // False if the queue, or the caller's part of it, is full and this job has its share of it:
    // then the job should bring no more until some of its own is solved.
    bool MayBringMore() const;

   private:
    friend class Admission;
    explicit Ticket(Admission& admission) : admission_(admission) {}

    void Count(int64_t points) TRAVERSE_REQUIRES(admission_.mutex_);
    void CountBytes(int64_t bytes) TRAVERSE_REQUIRES(admission_.mutex_);
    void CountAnswer(int64_t bytes) TRAVERSE_REQUIRES(admission_.mutex_);
    bool stalled() const TRAVERSE_REQUIRES(admission_.mutex_) {
      return is_worked_on_ && !is_worked_on_();
    }

    Admission& admission_;
    std::map<std::string, Caller>::iterator caller_ TRAVERSE_GUARDED_BY(admission_.mutex_);
    int64_t points_ TRAVERSE_GUARDED_BY(admission_.mutex_) = 0;
    int64_t bytes_ TRAVERSE_GUARDED_BY(admission_.mutex_) = 0;         // of layers to be solved
    int64_t answer_bytes_ TRAVERSE_GUARDED_BY(admission_.mutex_) = 0;  // that wait to be written
    std::string strategy_ TRAVERSE_GUARDED_BY(admission_.mutex_);
    std::function<bool()> is_worked_on_ TRAVERSE_GUARDED_BY(admission_.mutex_);
  };

  // `on_refusal` is called for each refusal, from any thread.
  Admission(const AdmissionLimits& limits, std::function<void(Refusal)> on_refusal);

  // Lets a job of `caller` in that is about to queue `points`. Errors: Unavailable while draining;
  // ResourceExhausted with a retry delay (server/jobs/retry_delay.h) if a limit is
  // reached. A job is let into an empty queue whatever its size.
  absl::StatusOr<std::unique_ptr<Ticket>> Admit(const std::string& caller, int64_t points);

  // Counts a refusal that was decided elsewhere.
  void CountRefusal(Refusal refusal) { on_refusal_(refusal); }

  // The process has more memory than it should: no job is let in until it has less.
  void SetMemoryShort(bool is_short);

  // From now on no job is let in.
  void StartDraining();
  bool draining() const;

  int jobs() const;
  int64_t queued_points() const;
  int64_t held_bytes() const;

 private:
  // Why the job may not come in; nothing if it may.
  struct No {
    Refusal refusal;
    absl::Status status;
  };
  std::optional<No> Check(const std::string& caller, int64_t points) const
      TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckPoints(const std::string& caller, int64_t points) const
      TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckQueues(const std::string& caller, int64_t points) const
      TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckWait(const std::string& caller, int64_t points,
                              const std::string& strategy) const TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckBytes(const Caller& caller, int64_t bytes) const TRAVERSE_REQUIRES(mutex_);

  // Points of a job that wait for a worker, and its time: none while its caller holds it up. A
  // ticket's mutex is this one's, which the compiler cannot see.
  int64_t WaitingPoints(const Ticket& job) const
      TRAVERSE_REQUIRES(mutex_) TRAVERSE_NO_THREAD_SAFETY_ANALYSIS;
  absl::Duration WaitingTime(const Ticket& job) const
      TRAVERSE_REQUIRES(mutex_) TRAVERSE_NO_THREAD_SAFETY_ANALYSIS;

  // Points that wait for a worker.
  int64_t PointsOfOthers(const std::string& caller) const TRAVERSE_REQUIRES(mutex_);

  // Time until a new job that takes `alone` is done, beside those that are there.
  absl::Duration TimeUntilDone(const std::string& caller, absl::Duration alone) const
      TRAVERSE_REQUIRES(mutex_);

  // Time of all workers for `points`, at the rate of late of a strategy, or of all if that is
  // unknown; zero while nothing is known.
  absl::Duration TimeFor(int64_t points, const std::string& strategy = "") const
      TRAVERSE_REQUIRES(mutex_);

  const AdmissionLimits limits_;
  const std::function<void(Refusal)> on_refusal_;
  mutable Mutex mutex_;
  bool draining_ TRAVERSE_GUARDED_BY(mutex_) = false;
  int jobs_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int64_t queued_points_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  std::map<std::string, Caller> callers_ TRAVERSE_GUARDED_BY(mutex_);  // those with jobs

  int64_t bytes_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  bool memory_short_ TRAVERSE_GUARDED_BY(mutex_) = false;

  // Of layers solved of late: sums whose older parts count ever less.
  struct Solved {
    double points = 0;
    double seconds = 0;
  };
  // By strategy, those of the registry; of all of them under the empty name.
  std::map<std::string, Solved> solved_ TRAVERSE_GUARDED_BY(mutex_);
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_ADMISSION_H_
