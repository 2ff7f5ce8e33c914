#include "server/admission.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "server/retry_delay.h"

namespace traverse {
namespace {

// Bounds of the advice when to come back: not at once, as the queue has to change first; and not so
// late that a caller gives up on a server that is free again.
constexpr absl::Duration kMinRetryDelay = absl::Milliseconds(100);
constexpr absl::Duration kMaxRetryDelay = absl::Seconds(30);

// Advice where the limit is on jobs, whose durations are not known.
constexpr absl::Duration kJobsRetryDelay = absl::Seconds(1);

// The rate is averaged over periods of this length, each new one counting kNewShare.
constexpr double kRatePeriodSeconds = 0.5;
constexpr double kNewShare = 0.3;

}  // namespace

const char* RefusalName(Refusal refusal) {
  switch (refusal) {
    case Refusal::kDraining:
      return "draining";
    case Refusal::kJobs:
      return "jobs";
    case Refusal::kCallerJobs:
      return "caller_jobs";
    case Refusal::kQueue:
      return "queue";
    case Refusal::kMessage:
      return "message";
    case Refusal::kJobLayers:
      return "job_layers";
    case Refusal::kJobPoints:
      return "job_points";
    case Refusal::kLayerPoints:
      return "layer_points";
    case Refusal::kUnauthenticated:
      return "unauthenticated";
    case Refusal::kPermission:
      return "permission";
  }
  return "other";
}

Admission::Admission(const AdmissionLimits& limits, std::function<void(Refusal)> on_refusal)
    : limits_(limits), on_refusal_(std::move(on_refusal)) {}

absl::StatusOr<std::unique_ptr<Admission::Ticket>> Admission::Admit(const std::string& caller,
                                                                    int64_t points) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (draining_) {
    lock.unlock();
    return Refuse(Refusal::kDraining,
                  absl::UnavailableError("the server is shutting down; ask another one"));
  }
  if (jobs_ >= limits_.max_jobs) {
    lock.unlock();
    return Refuse(
        Refusal::kJobs,
        WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                           "all ", limits_.max_jobs, " places for jobs are taken; try again")),
                       kJobsRetryDelay));
  }
  const auto of_caller = jobs_of_caller_.find(caller);
  if (of_caller != jobs_of_caller_.end() && of_caller->second >= limits_.max_jobs_per_caller) {
    lock.unlock();
    return Refuse(Refusal::kCallerJobs,
                  WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                                     "this caller has all of its ", limits_.max_jobs_per_caller,
                                     " jobs in flight; try again when one has ended")),
                                 kJobsRetryDelay));
  }
  const int64_t excess = queued_points_ + points - limits_.max_queued_points;
  if (excess > 0 && queued_points_ > 0) {
    const absl::Duration delay = TimeToDrain(std::min(excess, queued_points_));
    const int64_t queued = queued_points_;
    lock.unlock();
    return Refuse(
        Refusal::kQueue,
        WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                           "the queue is full: ", queued, " of ", limits_.max_queued_points,
                           " points, and this job has about ", points, "; try again")),
                       delay));
  }
  ++jobs_;
  ++jobs_of_caller_[caller];
  if (queued_points_ == 0) rate_since_ = Clock::now(), solved_points_ = 0;
  queued_points_ += points;
  std::unique_ptr<Ticket> ticket(new Ticket(*this, caller));
  ticket->points_ = points;
  return ticket;
}

absl::Status Admission::Refuse(Refusal refusal, absl::Status status) {
  on_refusal_(refusal);
  return status;
}

void Admission::StartDraining() {
  std::lock_guard<std::mutex> lock(mutex_);
  draining_ = true;
}

bool Admission::draining() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return draining_;
}

int Admission::jobs() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return jobs_;
}

int64_t Admission::queued_points() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return queued_points_;
}

absl::Duration Admission::TimeToDrain(int64_t points) const {
  if (points_per_second_ <= 0) return kJobsRetryDelay;
  return std::clamp(absl::Seconds(static_cast<double>(points) / points_per_second_), kMinRetryDelay,
                    kMaxRetryDelay);
}

void Admission::MeasureRate(int64_t points) {
  solved_points_ += points;
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - rate_since_).count();
  if (seconds < kRatePeriodSeconds) return;
  const double rate = static_cast<double>(solved_points_) / seconds;
  points_per_second_ =
      points_per_second_ <= 0 ? rate : (1 - kNewShare) * points_per_second_ + kNewShare * rate;
  solved_points_ = 0;
  rate_since_ = now;
}

Admission::Ticket::~Ticket() {
  std::lock_guard<std::mutex> lock(admission_.mutex_);
  admission_.queued_points_ -= points_;
  --admission_.jobs_;
  const auto of_caller = admission_.jobs_of_caller_.find(caller_);
  if (--of_caller->second == 0) admission_.jobs_of_caller_.erase(of_caller);
}

void Admission::Ticket::Add(int64_t points) {
  std::lock_guard<std::mutex> lock(admission_.mutex_);
  points_ += points;
  admission_.queued_points_ += points;
}

void Admission::Ticket::Remove(int64_t points) {
  std::lock_guard<std::mutex> lock(admission_.mutex_);
  points_ -= points;
  admission_.queued_points_ -= points;
  admission_.MeasureRate(points);
}

bool Admission::Ticket::MayBringMore() const {
  std::lock_guard<std::mutex> lock(admission_.mutex_);
  return points_ == 0 || admission_.queued_points_ < admission_.limits_.max_queued_points;
}

}  // namespace traverse
