#include "server/jobs/admission.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/jobs/retry_delay.h"

namespace traverse {
namespace {

// Bounds of the advice when to come back: not at once, because the queue has to change first; and
// not so late that a caller gives up on a server that is free again.
constexpr absl::Duration kMinRetryDelay = absl::Milliseconds(100);
constexpr absl::Duration kMaxRetryDelay = absl::Seconds(30);

// Advice where the limit is on jobs, whose durations are not known.
constexpr absl::Duration kJobsRetryDelay = absl::Seconds(1);

// With each solved layer, earlier ones lose this share of their weight.
constexpr double kFading = 0.998;

}  // namespace

Admission::Admission(const AdmissionLimits& limits, std::function<void(Refusal)> on_refusal,
                     std::function<void()> give_way, const TimeSource* time)
    : limits_(limits),
      on_refusal_(std::move(on_refusal)),
      give_way_(std::move(give_way)),
      time_(time) {}

absl::StatusOr<std::unique_ptr<Admission::Ticket>> Admission::Admit(const std::string& caller,
                                                                    int64_t points,
                                                                    Deadline deadline) {
  std::optional<No> no;
  {
    MutexLock lock(mutex_);
    no = Check(caller, points, deadline);
    if (!no) {
      std::unique_ptr<Ticket> ticket(new Ticket(*this));
      ticket->admission_.mutex_.AssertHeld();  // it is ours
      ticket->deadline_ = deadline;
      ticket->caller_ = callers_.try_emplace(caller).first;
      ticket->caller_->second.jobs.insert(ticket.get());
      ticket->Count(points);
      ++jobs_;
      return ticket;
    }
  }
  on_refusal_(no->refusal);
  if (no->newcomer) give_way_();
  return no->status;
}

std::optional<Admission::No> Admission::Check(const std::string& caller, int64_t points,
                                              Deadline deadline) const {
  if (draining_) {
    return No{Refusal::kDraining,
              absl::UnavailableError("the server is shutting down; ask another one")};
  }
  if (memory_short_) {
    return No{
        Refusal::kMemory,
        WithRetryDelay(absl::ResourceExhaustedError("the server is short of memory; try again"),
                       kJobsRetryDelay)};
  }
  if (std::optional<No> no = CheckPlaces(caller); no) return no;
  return CheckPoints(caller, points, deadline);
}

std::optional<Admission::No> Admission::CheckPlaces(const std::string& caller) const {
  const auto of_caller = callers_.find(caller);
  const int own = of_caller == callers_.end() ? 0 : static_cast<int>(of_caller->second.jobs.size());
  if (own >= limits_.max_jobs_per_caller) {
    return No{Refusal::kCallerJobs,
              WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                                 "this caller has all of its ", limits_.max_jobs_per_caller,
                                 " jobs in flight; try again when one has ended")),
                             kJobsRetryDelay)};
  }
  if (jobs_ >= limits_.max_jobs) {
    return No{
        Refusal::kJobs,
        WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                           "all ", limits_.max_jobs, " places for jobs are taken; try again")),
                       kJobsRetryDelay),
        own == 0};
  }
  if (own > 0 && jobs_ >= limits_.max_jobs - limits_.max_jobs / 4) {
    return No{Refusal::kJobs, WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                                                 "of ", limits_.max_jobs,
                                                 " places for jobs the last ", limits_.max_jobs / 4,
                                                 " are for callers who have none; try again")),
                                             kJobsRetryDelay)};
  }
  return std::nullopt;
}

std::optional<Admission::No> Admission::CheckPoints(const std::string& caller, int64_t points,
                                                    Deadline deadline) const {
  if (std::optional<No> no = CheckDeadline(caller, points, deadline); no) return no;
  if (std::optional<No> no = CheckQueues(caller, points); no) return no;
  return CheckWait(caller, points, "", deadline);
}

std::optional<Admission::No> Admission::CheckQueues(const std::string& caller,
                                                    int64_t points) const {
  const auto of_caller = callers_.find(caller);
  const int64_t own = of_caller == callers_.end() ? 0 : of_caller->second.queued_points;
  const auto full = [&](Refusal refusal, const char* what, int64_t queued,
                        int64_t limit) -> std::optional<No> {
    mutex_.AssertHeld();
    const int64_t excess = queued + points - limit;
    if (excess <= 0 || queued == 0) return std::nullopt;
    const absl::Duration delay = TimeFor(std::min(excess, queued));
    return No{refusal,
              WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                                 what, " is full: ", queued, " of ", limit,
                                 " points, and this job has about ", points, "; try again")),
                             std::clamp(delay, kMinRetryDelay, kMaxRetryDelay))};
  };
  if (auto no = full(Refusal::kQueue, "the queue", PointsOfOthers(caller) + own,
                     limits_.max_queued_points);
      no) {
    return no;
  }
  return full(Refusal::kCallerQueue, "this caller's share of the queue", own,
              limits_.max_queued_points_per_caller);
}

// While no other job of the caller is in flight, it has a head start.
std::optional<Admission::No> Admission::CheckDeadline(const std::string& caller, int64_t points,
                                                      Deadline deadline) const {
  const auto of_caller = callers_.find(caller);
  if (!deadline || of_caller == callers_.end()) return std::nullopt;
  const Budget::Clock::time_point now = Budget::Now(time_);
  const LeastAnswer::Seconds least = of_caller->second.least_answer.Of(
      static_cast<double>(points) + PointsDueBefore(caller, points, deadline), now);
  const LeastAnswer::Seconds left = *deadline - now;
  if (least <= left) return std::nullopt;
  const absl::Duration late = absl::Seconds((least - left).count());
  return No{
      Refusal::kDeadline,
      WithRetryDelay(
          absl::ResourceExhaustedError(absl::StrCat(
              "the deadline is too early: this job would take about ",
              absl::FormatDuration(
                  absl::Trunc(absl::Seconds(least.count()), absl::Milliseconds(1))),
              " even by greedy, and has ",
              absl::FormatDuration(absl::Trunc(absl::Seconds(left.count()), absl::Milliseconds(1))),
              "; try again")),
          std::clamp(late, kMinRetryDelay, kMaxRetryDelay))};
}

int64_t Admission::WaitingPoints(const Ticket& job) const {
  return job.stalled() ? 0 : job.points_;
}

absl::Duration Admission::WaitingTime(const Ticket& job) const {
  return job.stalled() ? absl::ZeroDuration() : TimeFor(job.points_, job.strategy_);
}

int64_t Admission::PointsDueBefore(const Caller& caller, Deadline deadline) {
  int64_t points = 0;
  for (const Ticket* job : caller.jobs) {
    job->admission_.mutex_.AssertHeld();  // it is ours
    if (job->deadline_ && *job->deadline_ <= *deadline) points += job->points_;
  }
  return points;
}

double Admission::PointsDueBefore(const std::string& caller, int64_t points,
                                  Deadline deadline) const {
  const auto of_caller = callers_.find(caller);
  const int64_t own =
      of_caller == callers_.end() ? 0 : PointsDueBefore(of_caller->second, deadline);
  int64_t all = own;
  for (auto other = callers_.begin(); other != callers_.end(); ++other) {
    if (other != of_caller) all += std::min(PointsDueBefore(other->second, deadline), own + points);
  }
  return static_cast<double>(all) / limits_.workers;
}

int64_t Admission::PointsOfOthers(const std::string& caller) const {
  int64_t points = 0;
  for (const auto& [name, other] : callers_) {
    if (name == caller) continue;
    for (const Ticket* job : other.jobs) points += WaitingPoints(*job);
  }
  return points;
}

// A search that the clock cuts short takes as long as it is given, also alone.
std::optional<Admission::No> Admission::CheckWait(const std::string& caller, int64_t points,
                                                  const std::string& strategy,
                                                  Deadline deadline) const {
  const absl::Duration alone = TimeFor(points, strategy);
  const absl::Duration expected = TimeUntilDone(caller, alone);
  absl::Duration whole = alone;
  if (deadline) {
    const absl::Duration given = absl::FromChrono(*deadline - Budget::Now(time_));
    whole = std::max(whole, ShareCutShort(strategy) * given);
  }
  const absl::Duration bearable = std::max(limits_.max_wait, whole * limits_.max_slowdown);
  if (expected <= bearable) return std::nullopt;
  return No{
      Refusal::kWait,
      WithRetryDelay(
          absl::ResourceExhaustedError(absl::StrCat(
              "the server is busy: this job would take about ",
              absl::FormatDuration(absl::Trunc(expected, absl::Milliseconds(1))), ", alone ",
              absl::FormatDuration(absl::Trunc(alone, absl::Milliseconds(1))), "; try again")),
          std::clamp(expected - bearable, kMinRetryDelay, kMaxRetryDelay))};
}

absl::Duration Admission::TimeUntilDone(const std::string& caller, absl::Duration alone) const {
  absl::Duration own = alone;
  const auto of_caller = callers_.find(caller);
  if (of_caller != callers_.end()) {
    for (const Ticket* job : of_caller->second.jobs) own += std::min(WaitingTime(*job), alone);
  }
  absl::Duration all = own;
  for (auto other = callers_.begin(); other != callers_.end(); ++other) {
    if (other == of_caller) continue;
    absl::Duration of_other = absl::ZeroDuration();
    for (const Ticket* job : other->second.jobs) of_other += WaitingTime(*job);
    all += std::min(of_other, own);
  }
  return all;
}

std::optional<Admission::No> Admission::CheckBytes(const Caller& caller, int64_t bytes,
                                                   int64_t beside) const {
  struct Share {
    Refusal refusal;
    const char* whose;
    int64_t held;
    int64_t limit;
  };
  const Share shares[] = {{Refusal::kMemory, "the server's", bytes_, limits_.max_bytes},
                          {Refusal::kCallerMemory, "this caller's share of the", caller.bytes,
                           limits_.max_bytes_per_caller}};
  // What is too large for an empty server stays too large: nobody is told to try that again.
  for (const Share& share : shares) {
    if (bytes <= share.limit - beside) continue;
    return No{share.refusal,
              absl::ResourceExhaustedError(absl::StrCat(
                  "this message needs about ", (bytes + beside) >> 20, " MiB, more than all of ",
                  share.whose, " memory for jobs, ", share.limit >> 20))};
  }
  for (const Share& share : shares) {
    if (bytes <= share.limit - share.held) continue;
    return No{share.refusal,
              WithRetryDelay(absl::ResourceExhaustedError(absl::StrCat(
                                 share.whose, " memory is in use: ", share.held >> 20, " of ",
                                 share.limit >> 20, " MiB, and this message needs about ",
                                 bytes >> 20, "; try again")),
                             kJobsRetryDelay)};
  }
  return std::nullopt;
}

void Admission::SetMemoryShort(bool is_short) {
  MutexLock lock(mutex_);
  memory_short_ = is_short;
}

void Admission::StartDraining() {
  MutexLock lock(mutex_);
  draining_ = true;
}

bool Admission::draining() const {
  MutexLock lock(mutex_);
  return draining_;
}

int Admission::jobs() const {
  MutexLock lock(mutex_);
  return jobs_;
}

int64_t Admission::queued_points() const {
  MutexLock lock(mutex_);
  return queued_points_;
}

int64_t Admission::held_bytes() const {
  MutexLock lock(mutex_);
  return bytes_;
}

const Admission::Solved* Admission::SolvedBy(const std::string& strategy) const {
  auto solved = solved_.find(strategy);
  if (solved == solved_.end()) solved = solved_.find("");
  return solved == solved_.end() || solved->second.points <= 0 ? nullptr : &solved->second;
}

absl::Duration Admission::TimeFor(int64_t points, const std::string& strategy) const {
  const Solved* solved = SolvedBy(strategy);
  if (solved == nullptr) return absl::ZeroDuration();
  return absl::Seconds(static_cast<double>(points) * solved->seconds / solved->points /
                       limits_.workers);
}

double Admission::ShareCutShort(const std::string& strategy) const {
  const Solved* solved = SolvedBy(strategy);
  return solved == nullptr ? 0 : solved->cut_short / solved->points;
}

Admission::Ticket::~Ticket() {
  MutexLock lock(admission_.mutex_);
  Count(-points_);
  CountBytes(-bytes_);
  CountAnswer(-answer_bytes_);
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
    MutexLock lock(admission_.mutex_);
    const int64_t before = points_;
    Count(-before);
    if (points > before) no = admission_.CheckPoints(caller_->first, points, deadline_);
    if (!no) Count(points);
  }
  if (!no) return absl::OkStatus();
  admission_.on_refusal_(no->refusal);
  return no->status;
}

void Admission::Ticket::Add(int64_t points) {
  MutexLock lock(admission_.mutex_);
  Count(points);
}

void Admission::Ticket::Remove(int64_t points, int64_t bytes, double seconds, bool cut_short) {
  MutexLock lock(admission_.mutex_);
  CountBytes(-std::min(bytes, bytes_));
  Count(-points);
  for (const std::string& name : {strategy_, std::string()}) {
    Solved& solved = admission_.solved_[name];
    solved.points = solved.points * kFading + static_cast<double>(points);
    solved.seconds = solved.seconds * kFading + seconds;
    solved.cut_short = solved.cut_short * kFading + (cut_short ? static_cast<double>(points) : 0);
    if (strategy_.empty()) break;
  }
}

void Admission::Ticket::NoteLag(double seconds) {
  MutexLock lock(admission_.mutex_);
  caller_->second.least_answer.NoteLag(LeastAnswer::Seconds(seconds),
                                       Budget::Now(admission_.time_));
}

double Admission::Ticket::PointsDueBefore() const {
  MutexLock lock(admission_.mutex_);
  if (!deadline_) return 0;
  const double own = static_cast<double>(points_) / admission_.limits_.workers;
  return admission_.PointsDueBefore(caller_->first, 0, deadline_) - own;
}

void Admission::Ticket::CountBytes(int64_t bytes) {
  bytes_ += bytes;
  caller_->second.bytes += bytes;
  admission_.bytes_ += bytes;
}

void Admission::Ticket::CountAnswer(int64_t bytes) {
  answer_bytes_ += bytes;
  caller_->second.bytes += bytes;
  admission_.bytes_ += bytes;
}

void Admission::Ticket::KeepAnswer(int64_t bytes) {
  MutexLock lock(admission_.mutex_);
  CountAnswer(bytes);
}

void Admission::Ticket::LetGoAnswer(int64_t bytes) {
  MutexLock lock(admission_.mutex_);
  CountAnswer(-std::min(bytes, answer_bytes_));
}

absl::Status Admission::Ticket::Hold(int64_t bytes, int64_t beside) {
  std::optional<No> no;
  {
    MutexLock lock(admission_.mutex_);
    no = admission_.CheckBytes(caller_->second, bytes, beside);
    if (!no) CountBytes(bytes);
  }
  if (!no) return absl::OkStatus();
  admission_.on_refusal_(no->refusal);
  return no->status;
}

void Admission::Ticket::LetGo(int64_t bytes) {
  MutexLock lock(admission_.mutex_);
  CountBytes(-std::min(bytes, bytes_));
}

absl::Status Admission::Ticket::SetStrategy(const std::string& strategy) {
  std::optional<No> no;
  {
    MutexLock lock(admission_.mutex_);
    strategy_ = strategy;
    const int64_t points = points_;
    Count(-points);  // this ticket does not count as another job
    if (points > 0) no = admission_.CheckWait(caller_->first, points, strategy, deadline_);
    Count(points);
  }
  if (!no) return absl::OkStatus();
  admission_.on_refusal_(no->refusal);
  return no->status;
}

void Admission::Ticket::WatchWork(std::function<bool()> is_worked_on) {
  MutexLock lock(admission_.mutex_);
  is_worked_on_ = std::move(is_worked_on);
}

bool Admission::Ticket::MayBringMore() const {
  MutexLock lock(admission_.mutex_);
  const AdmissionLimits& limits = admission_.limits_;
  return points_ == 0 || (admission_.queued_points_ < limits.max_queued_points &&
                          caller_->second.queued_points < limits.max_queued_points_per_caller);
}

}  // namespace traverse
