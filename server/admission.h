// Who may come in: limits on jobs and on queued work.
//
// Work is counted in points: the time and the memory that a layer takes grow with them, a request's
// or a layer's do not. A job is refused as a whole and at once, before any work; what was let in is
// done. Streams that were let in are held back, not refused, while the queue is full.
//
// Knows nothing of gRPC.

#ifndef TRAVERSE_SERVER_ADMISSION_H_
#define TRAVERSE_SERVER_ADMISSION_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace traverse {

struct AdmissionLimits {
  int max_jobs = 256;                     // in flight
  int max_jobs_per_caller = 64;           // in flight
  int64_t max_queued_points = 8'000'000;  // of all jobs together, not yet solved
};

// Why a job was refused; the label of a metric.
enum class Refusal {
  kDraining,
  kJobs,
  kCallerJobs,
  kQueue,
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
  // The place of one job; leaves when it is destroyed. Thread-safe. Outlived by the Admission.
  class Ticket {
   public:
    ~Ticket();
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

    // Counts `points` more as queued, whether there is room or not.
    void Add(int64_t points);

    // `points` are solved or were counted in vain.
    void Remove(int64_t points);

    // False if the queue is full and this job has its share of it: then the job should bring no
    // more until some of its own is solved.
    bool MayBringMore() const;

   private:
    friend class Admission;
    Ticket(Admission& admission, std::string caller)
        : admission_(admission), caller_(std::move(caller)) {}

    Admission& admission_;
    const std::string caller_;
    int64_t points_ = 0;  // guarded by admission_.mutex_
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
  using Clock = std::chrono::steady_clock;

  absl::Status Refuse(Refusal refusal, absl::Status status);

  // Time until `points` of the queue are solved, at the rate of late. REQUIRES: mutex_ is held.
  absl::Duration TimeToDrain(int64_t points) const;

  // Notes `points` as solved. REQUIRES: mutex_ is held.
  void MeasureRate(int64_t points);

  const AdmissionLimits limits_;
  const std::function<void(Refusal)> on_refusal_;
  mutable std::mutex mutex_;
  bool draining_ = false;
  int jobs_ = 0;
  int64_t queued_points_ = 0;
  std::map<std::string, int> jobs_of_caller_;

  double points_per_second_ = 0;  // 0: not yet known
  int64_t solved_points_ = 0;     // since rate_since_
  Clock::time_point rate_since_ = Clock::now();
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_ADMISSION_H_
