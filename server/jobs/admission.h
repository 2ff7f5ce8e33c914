// Decides which jobs may enter: limits on jobs and on queued work.
//
// Work is counted in points, because the time and memory of a layer grow with them; those of a
// request or a layer do not. A job is refused as a whole and at once, before any work; an admitted
// job is done. While the queue is full, admitted streams are held back, not refused.
//
// A job is also refused if it would take much longer than alone. Workers take turns, so a job of p
// points is done when each other job of its caller has had p points of work or has ended, and each
// other caller as much as this one. So small jobs are admitted beside large ones that would have to
// wait themselves; under overload the large ones are refused first. And it is refused if its
// deadline is too early even for greedy, after what is due before it, by how long the way back to
// its caller took of late: it would only take the time of those that can be answered.
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
#include "engine/base/budget.h"
#include "engine/base/mutex.h"
#include "server/jobs/least_answer.h"

namespace traverse {

struct AdmissionLimits {
  int max_jobs = 256;                     // in flight
  int max_jobs_per_caller = 64;           // in flight
  int64_t max_queued_points = 8'000'000;  // of all jobs together, not yet solved
  int64_t max_queued_points_per_caller = 4'000'000;

  // Refuse jobs expected to take longer than both `max_wait` and `max_slowdown` times as long as
  // alone.
  absl::Duration max_wait = absl::Milliseconds(250);
  double max_slowdown = 3;

  int workers = 1;

  // Memory that the server holds for jobs: what their messages need, as counted, and answers.
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
  kDeadline,
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
  using Deadline = std::optional<Budget::Clock::time_point>;

 private:
  // A caller with jobs in flight.
  struct Caller {
    std::set<const Ticket*> jobs;
    int64_t queued_points = 0;
    int64_t bytes = 0;
    LeastAnswer least_answer;
  };

 public:
  // The place of one job, given up on destruction. Thread-safe. The Admission must outlive it.
  class Ticket {
   public:
    ~Ticket();
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

    // Corrects the job's size to `points`, none of which it has brought yet. Errors: as Admit, if
    // the size is larger than stated then; the job must end.
    absl::Status Resize(int64_t points);

    // Counts `points` more as queued, whether or not there is room.
    void Add(int64_t points);

    // Notes that a layer of `points`, for which `bytes` were held, took a worker `seconds`.
    // `cut_short`: by the clock.
    void Remove(int64_t points, int64_t bytes, double seconds, bool cut_short = false);

    // Notes how long after the end of its search the job ended.
    void NoteLag(double seconds);

    // The points of other jobs that greedy must do before this one's deadline, for each worker.
    double PointsDueBefore() const;

    // Counts `bytes` more, or less, that the server holds for the job. Errors: ResourceExhausted,
    // as Admit, if the memory for jobs is used up; then it counts nothing. `beside`: what the same
    // message holds already, and keeps meanwhile.
    absl::Status Hold(int64_t bytes, int64_t beside = 0);
    void LetGo(int64_t bytes);

    // The same for answers, which exist whether or not there is room. Those that wait for a slow
    // reader take the place of new jobs.
    void KeepAnswer(int64_t bytes);
    void LetGoAnswer(int64_t bytes);

    // Notes the job's strategy, which gives a better estimate of its time. Errors: as Admit.
    absl::Status SetStrategy(const std::string& strategy);

    // Sets how to ask, with a lock held, whether workers have work for the job. If not, because its
    // caller does not read or send, its points are no load for others.
    void WatchWork(std::function<bool()> is_worked_on);

    // False if the queue, or the caller's share of it, is full and this job has its own share: then
    // the job should bring no more until some of it is solved.
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
    int64_t bytes_ TRAVERSE_GUARDED_BY(admission_.mutex_) = 0;         // of layers, while kept
    int64_t answer_bytes_ TRAVERSE_GUARDED_BY(admission_.mutex_) = 0;  // of answers not yet written
    std::string strategy_ TRAVERSE_GUARDED_BY(admission_.mutex_);
    Deadline deadline_ TRAVERSE_GUARDED_BY(admission_.mutex_);
    std::function<bool()> is_worked_on_ TRAVERSE_GUARDED_BY(admission_.mutex_);
  };

  // Calls `on_refusal` for each refusal, from any thread. `give_way`: called when all places are
  // taken and a caller who has none asks for one; ends a job that has nothing to do, so that there
  // is a place when the caller comes back. `time`: the clock of deadlines; null: the steady clock.
  Admission(
      const AdmissionLimits& limits, std::function<void(Refusal)> on_refusal,
      std::function<void()> give_way = [] {}, const TimeSource* time = nullptr);

  // Admits a job of `caller` that is about to queue `points` and must end by `deadline`, if that is
  // set. The last quarter of the places is for callers who have none. Errors: Unavailable while
  // draining;
  // ResourceExhausted with a retry delay (server/jobs/retry_delay.h) if a limit is reached. An
  // empty queue admits a job of any size.
  absl::StatusOr<std::unique_ptr<Ticket>> Admit(const std::string& caller, int64_t points,
                                                Deadline deadline = std::nullopt);

  // Counts a refusal that was decided elsewhere.
  void CountRefusal(Refusal refusal) { on_refusal_(refusal); }

  // While `is_short`, the process uses too much memory, and no job is admitted.
  void SetMemoryShort(bool is_short);

  // From now on no job is admitted.
  void StartDraining();
  bool draining() const;

  int jobs() const;
  int64_t queued_points() const;
  int64_t held_bytes() const;

 private:
  // Why a job may not enter; unset if it may.
  struct No {
    Refusal refusal;
    absl::Status status;
    bool newcomer = false;  // for want of a place, though the caller has none
  };
  std::optional<No> Check(const std::string& caller, int64_t points, Deadline deadline) const
      TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckPlaces(const std::string& caller) const TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckPoints(const std::string& caller, int64_t points, Deadline deadline) const
      TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckDeadline(const std::string& caller, int64_t points,
                                  Deadline deadline) const TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckQueues(const std::string& caller, int64_t points) const
      TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckWait(const std::string& caller, int64_t points,
                              const std::string& strategy, Deadline deadline) const
      TRAVERSE_REQUIRES(mutex_);
  std::optional<No> CheckBytes(const Caller& caller, int64_t bytes, int64_t beside) const
      TRAVERSE_REQUIRES(mutex_);

  // The job's points that wait for a worker, and their time; none while its caller holds it up. A
  // ticket's mutex is this one's, which the compiler cannot see.
  int64_t WaitingPoints(const Ticket& job) const
      TRAVERSE_REQUIRES(mutex_) TRAVERSE_NO_THREAD_SAFETY_ANALYSIS;
  absl::Duration WaitingTime(const Ticket& job) const
      TRAVERSE_REQUIRES(mutex_) TRAVERSE_NO_THREAD_SAFETY_ANALYSIS;

  // Points that wait of jobs of `caller` which are due by `deadline`, and of other callers as much
  // as that and `points` at most, for each worker.
  double PointsDueBefore(const std::string& caller, int64_t points, Deadline deadline) const
      TRAVERSE_REQUIRES(mutex_);
  static int64_t PointsDueBefore(const Caller& caller, Deadline deadline);

  // Points of other callers that wait for a worker.
  int64_t PointsOfOthers(const std::string& caller) const TRAVERSE_REQUIRES(mutex_);

  // Time until a new job that takes `alone` is done beside the present ones.
  absl::Duration TimeUntilDone(const std::string& caller, absl::Duration alone) const
      TRAVERSE_REQUIRES(mutex_);

  // Time of all workers for `points`, at the recent rate of `strategy`, or of all strategies if
  // that is unknown; zero while nothing is known.
  absl::Duration TimeFor(int64_t points, const std::string& strategy = "") const
      TRAVERSE_REQUIRES(mutex_);

  // How much of what `strategy` solved of late the clock cut short, from 0 to 1.
  double ShareCutShort(const std::string& strategy) const TRAVERSE_REQUIRES(mutex_);

  const AdmissionLimits limits_;
  const std::function<void(Refusal)> on_refusal_;
  const std::function<void()> give_way_;
  const TimeSource* const time_;
  mutable Mutex mutex_;
  bool draining_ TRAVERSE_GUARDED_BY(mutex_) = false;
  int jobs_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int64_t queued_points_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  std::map<std::string, Caller> callers_ TRAVERSE_GUARDED_BY(mutex_);  // those with jobs

  int64_t bytes_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  bool memory_short_ TRAVERSE_GUARDED_BY(mutex_) = false;

  // Recently solved layers: sums in which older layers count ever less.
  struct Solved {
    double points = 0;
    double seconds = 0;
    double cut_short = 0;  // points
  };
  const Solved* SolvedBy(const std::string& strategy) const TRAVERSE_REQUIRES(mutex_);
  // By strategy of the registry; the empty name has the sum of all.
  std::map<std::string, Solved> solved_ TRAVERSE_GUARDED_BY(mutex_);
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_ADMISSION_H_
