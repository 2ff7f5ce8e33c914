#include "server/admission.h"

#include <algorithm>
#include <utility>

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

// With each layer solved the earlier ones count by so much less.
constexpr double kFading = 0.998;

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
    case Refusal::kCallerQueue:
      return "caller_queue";
    case Refusal::kWait:
      return "wait";
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
  std::optional<No> no;
  {
    std::lock_guard<std::mutex> lock(mutex_);
    no = Check(caller, points);
    if (!no) {
      std::unique_ptr<Ticket> ticket(new Ticket(*this));
      ticket->caller_ = callers_.try_emplace(caller).first;
      ticket->caller_->second.jobs.insert(ticket.get());
      ticket->Count(points);
      ++jobs_;
      return ticket;
    }
  }
  on_refusal_(no->refusal);
  return no->status;
}

std::optional<Admission::No> Admission::Check(const std::string& caller, int64_t points) const {
  if (draining_) {
    return No{Refusal::kDraining,
              absl::UnavailableError("the server is shutting down; ask another one")};
  }
  if (jobs_ >= limits_.max_jobs) {
    return No{
        Refusal::kJobs,
        WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                           "all ", limits_.max_jobs, " places for jobs are taken; try again")),
                       kJobsRetryDelay)};
  }
  const auto of_caller = callers_.find(caller);
  if (of_caller != callers_.end() &&
      static_cast<int>(of_caller->second.jobs.size()) >= limits_.max_jobs_per_caller) {
    return No{Refusal::kCallerJobs,
              WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                                 "this caller has all of its ", limits_.max_jobs_per_caller,
                                 " jobs in flight; try again when one has ended")),
                             kJobsRetryDelay)};
  }
  return CheckPoints(caller, points);
}

std::optional<Admission::No> Admission::CheckPoints(const std::string& caller,
                                                    int64_t points) const {
  if (std::optional<No> no = CheckQueues(caller, points); no) return no;
  return CheckWait(caller, points);
}

std::optional<Admission::No> Admission::CheckQueues(const std::string& caller,
                                                    int64_t points) const {
  const auto of_caller = callers_.find(caller);
  const int64_t own = of_caller == callers_.end() ? 0 : of_caller->second.queued_points;
  const auto full = [&](Refusal refusal, const char* what, int64_t queued,
                        int64_t limit) -> std::optional<No> {
    const int64_t excess = queued + points - limit;
    if (excess <= 0 || queued == 0) return std::nullopt;
    const absl::Duration delay = TimeFor(std::min(excess, queued));
    return No{refusal,
              WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                                 what, " is full: ", queued, " of ", limit,
                                 " points, and this job has about ", points, "; try again")),
                             std::clamp(delay, kMinRetryDelay, kMaxRetryDelay))};
  };
  if (auto no = full(Refusal::kQueue, "the queue", queued_points_, limits_.max_queued_points); no) {
    return no;
  }
  return full(Refusal::kCallerQueue, "this caller's part of the queue", own,
              limits_.max_queued_points_per_caller);
}

std::optional<Admission::No> Admission::CheckWait(const std::string& caller, int64_t points) const {
  const absl::Duration expected = TimeFor(PointsUntilDone(caller, points));
  const absl::Duration bearable =
      std::max(limits_.max_wait, TimeFor(points) * limits_.max_slowdown);
  if (expected <= bearable) return std::nullopt;
  return No{Refusal::kWait,
            WithRetryDelay(
                absl::ResourceExhaustedError(absl::StrCat(
                    "the server is busy: this job would take about ",
                    absl::FormatDuration(absl::Trunc(expected, absl::Milliseconds(1))), ", alone ",
                    absl::FormatDuration(absl::Trunc(TimeFor(points), absl::Milliseconds(1))),
                    "; try again")),
                std::clamp(expected - bearable, kMinRetryDelay, kMaxRetryDelay))};
}

int64_t Admission::PointsUntilDone(const std::string& caller, int64_t points) const {
  int64_t own = points;
  const auto of_caller = callers_.find(caller);
  if (of_caller != callers_.end()) {
    for (const Ticket* job : of_caller->second.jobs) own += std::min(job->points_, points);
  }
  int64_t all = own;
  for (auto other = callers_.begin(); other != callers_.end(); ++other) {
    if (other != of_caller) all += std::min(other->second.queued_points, own);
  }
  return all;
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

absl::Duration Admission::TimeFor(int64_t points) const {
  if (solved_points_ <= 0) return absl::ZeroDuration();
  return absl::Seconds(static_cast<double>(points) * solved_seconds_ / solved_points_ /
                       limits_.workers);
}

Admission::Ticket::~Ticket() {
  std::lock_guard<std::mutex> lock(admission_.mutex_);
  Count(-points_);
  --admission_.jobs_;
  caller_->second.jobs.erase(this);
  if (caller_->second.jobs.empty()) admission_.callers_.erase(caller_);
}

void Admission::Ticket::Count(int64_t points) {
  points_ += points;
  caller_->second.queued_points += points;
  admission_.queued_points_ += points;
}

absl::Status Admission::Ticket::Resize(int64_t points) {
  std::optional<No> no;
  {
    std::lock_guard<std::mutex> lock(admission_.mutex_);
    const int64_t before = points_;
    Count(-before);
    if (points > before) no = admission_.CheckPoints(caller_->first, points);
    if (!no) Count(points);
  }
  if (!no) return absl::OkStatus();
  admission_.on_refusal_(no->refusal);
  return no->status;
}

void Admission::Ticket::Add(int64_t points) {
  std::lock_guard<std::mutex> lock(admission_.mutex_);
  Count(points);
}

void Admission::Ticket::Remove(int64_t points, double seconds) {
  std::lock_guard<std::mutex> lock(admission_.mutex_);
  Count(-points);
  admission_.solved_points_ = admission_.solved_points_ * kFading + static_cast<double>(points);
  admission_.solved_seconds_ = admission_.solved_seconds_ * kFading + seconds;
}

bool Admission::Ticket::MayBringMore() const {
  std::lock_guard<std::mutex> lock(admission_.mutex_);
  const AdmissionLimits& limits = admission_.limits_;
  return points_ == 0 || (admission_.queued_points_ < limits.max_queued_points &&
                          caller_->second.queued_points < limits.max_queued_points_per_caller);
}

}  // namespace traverse
