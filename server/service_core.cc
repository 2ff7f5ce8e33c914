#include "server/service_core.h"

#include <malloc.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"

namespace traverse {

namespace {

// How often stalled jobs are looked for.
constexpr absl::Duration kLeastWatch = absl::Milliseconds(10);
constexpr absl::Duration kMostWatch = absl::Seconds(1);

// After jobs of 100 MB the allocator keeps most of it, in case that such jobs come again. To give
// it back takes some milliseconds, in which others who allocate wait.
constexpr auto kIdleBeforeTrim = std::chrono::seconds(5);

AdmissionLimits WithWorkers(AdmissionLimits limits, int workers) {
  limits.workers = workers;
  return limits;
}

}  // namespace

ServiceCore::ServiceCore(const ServiceOptions& options)
    : limits(options.limits),
      log(options.log ? std::make_unique<JobLog>(options.log_path) : std::make_unique<JobLog>()),
      admission(WithWorkers(options.admission, std::max(1, options.threads)),
                [this](Refusal refusal) { metrics.CountRefusal(refusal); }),
      pool(options.threads, WorkerPool::ThreadCpuSeconds, options.worker_nice) {
  if (limits.idle_timeout == absl::InfiniteDuration()) return;
  watch_.emplace(
      absl::ToChronoNanoseconds(std::clamp(limits.idle_timeout / 4, kLeastWatch, kMostWatch)),
      [this] {
        AbortStalled();
        TrimIfIdle(std::chrono::steady_clock::now());
      });
}

void ServiceCore::AbortStalled() {
  const absl::Status status = absl::DeadlineExceededError(
      absl::StrCat("nothing was sent or read for ", absl::FormatDuration(limits.idle_timeout)));
  for (const auto& run : Runs()) {
    run->AbortIfStalled(absl::ToChronoNanoseconds(limits.idle_timeout), status);
  }
}

bool ServiceCore::TrimIfIdle(std::chrono::steady_clock::time_point now) {
  bool idle = false;
  {
    std::lock_guard<std::mutex> lock(mutex_);
    idle = runs_.empty() && seen_registered_ == registered_;
    seen_registered_ = registered_;
  }
  if (!idle) {
    trimmed_ = false;
    idle_since_ = now;
  }
  if (trimmed_ || now - idle_since_ < kIdleBeforeTrim) return false;
  malloc_trim(0);
  return trimmed_ = true;
}

std::vector<std::shared_ptr<JobRun>> ServiceCore::Runs() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return {runs_.begin(), runs_.end()};
}

absl::Status ServiceCore::StartAuth(const AuthOptions& options) {
  absl::StatusOr<std::unique_ptr<Authenticator>> made =
      Authenticator::Make(options, [this](const absl::Status& status) {
        log->Event(status.ok() ? JobLog::Level::kInfo : JobLog::Level::kError, "tokens_reloaded",
                   {{"result", status.ok() ? "ok" : std::string(status.message())}});
      });
  if (!made.ok()) return made.status();
  auth = *std::move(made);
  return absl::OkStatus();
}

void ServiceCore::Register(const std::shared_ptr<JobRun>& run) {
  std::lock_guard<std::mutex> lock(mutex_);
  runs_.insert(run);
  ++registered_;
}

void ServiceCore::Unregister(const std::shared_ptr<JobRun>& run) {
  std::lock_guard<std::mutex> lock(mutex_);
  runs_.erase(run);
}

size_t ServiceCore::calls() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return runs_.size();
}

void ServiceCore::AbortAll(const absl::Status& status) {
  for (const auto& run : Runs()) run->Abort(status);
}

std::string ServiceCore::MetricsText() {
  Metrics::Gauges gauges;
  gauges.queue_layers = static_cast<double>(queue_layers.load());
  gauges.queue_points = static_cast<double>(admission.queued_points());
  gauges.jobs_in_flight = admission.jobs();
  gauges.workers_busy = pool.busy();
  gauges.workers = pool.threads();
  gauges.ready = admission.draining() ? 0 : 1;
  return metrics.Text(gauges);
}

}  // namespace traverse
