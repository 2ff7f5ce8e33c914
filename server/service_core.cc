#include "server/service_core.h"

#include <malloc.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "server/jobs/retry_delay.h"
#include "server/net/socket_info.h"

namespace traverse {

namespace {

// How often stalled jobs are looked for.
constexpr absl::Duration kLeastWatch = absl::Milliseconds(10);
constexpr absl::Duration kMostWatch = absl::Seconds(1);

// After jobs of 100 MB the allocator keeps most of it for similar jobs. Returning it takes some
// milliseconds, in which others who allocate wait.
constexpr auto kIdleBeforeTrim = std::chrono::seconds(5);

// How long a job may have nothing to do while somebody waits for a place, and when it may come
// back.
constexpr auto kGiveWay = std::chrono::seconds(2);
constexpr absl::Duration kGiveWayRetryDelay = absl::Seconds(1);

// What paused searches may hold in addition to the layers that they work on.
constexpr double kSearchShare = 0.25;

AdmissionLimits WithWorkers(AdmissionLimits limits, int workers) {
  limits.workers = workers;
  return limits;
}

}  // namespace

ServiceCore::ServiceCore(const ServiceOptions& options)
    : limits(options.limits),
      files(options.log ? std::make_unique<JobLog>(options.log_path) : std::make_unique<JobLog>(),
            [this](const std::string& what) { metrics.CountReloadFailure(what); }),
      admission(
          WithWorkers(options.admission, std::max(1, options.threads)),
          [this](Refusal refusal) { metrics.CountRefusal(refusal); }, [this] { GiveWay(); }),
      pool(options.threads, WorkerPool::ThreadCpuSeconds, options.worker_nice),
      wakes_(WakeLateness::kPeriod, [this] { wake_lateness.Tick(Budget::Clock::now()); }) {
  pool.SetWeights(options.caller_weights);
  if (options.watchdog != absl::InfiniteDuration()) {
    watchdog_.emplace(pool, options.watchdog, [this](const SilentTask& task) {
      files.log->Event(JobLog::Level::kError, "worker_silent",
                       {{"job_id", task.job},
                        {"caller", task.caller},
                        {"seconds", absl::StrFormat("%.1f", task.seconds)}});
    });
  }
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
  const auto time = absl::ToChronoNanoseconds(limits.idle_timeout);
  for (const Call& call : Calls()) {
    call.run->AbortIfStalled(time, status);
    if (call.run->HasEnded(time)) call.cancel();
  }
}

void ServiceCore::GiveWay() {
  std::shared_ptr<JobRun> idlest;
  for (const Call& call : Calls()) {
    if (!call.run->IsStalled(kGiveWay)) continue;
    if (idlest == nullptr || call.run->progress() < idlest->progress()) idlest = call.run;
  }
  if (idlest == nullptr) return;
  idlest->AbortIfStalled(
      kGiveWay, WithRetryDelay(absl::ResourceExhaustedError(
                                   absl::StrCat("nothing was sent or read for ",
                                                absl::FormatDuration(absl::FromChrono(kGiveWay)),
                                                " while others waited for a place")),
                               kGiveWayRetryDelay));
}

bool ServiceCore::TrimIfIdle(std::chrono::steady_clock::time_point now) {
  bool idle = false;
  {
    MutexLock lock(mutex_);
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

std::vector<ServiceCore::Call> ServiceCore::Calls() const {
  MutexLock lock(mutex_);
  std::vector<Call> calls;
  for (const auto& [key, call] : runs_) calls.push_back(call);
  return calls;
}

void ServiceCore::Register(const std::shared_ptr<JobRun>& run, const std::string& peer,
                           std::function<void()> cancel) {
  const double pending_before = connections_ != nullptr ? connections_->OnJob(peer) : 0;
  MutexLock lock(mutex_);
  runs_[run.get()] = {run, std::move(cancel), PeerKey(peer), pending_before};
  ++registered_;
}

void ServiceCore::Unregister(const std::shared_ptr<JobRun>& run, const std::string& peer) {
  double pending_before = 0;
  {
    MutexLock lock(mutex_);
    const auto call = runs_.find(run.get());
    pending_before = call->second.pending_before;
    runs_.erase(call);
  }
  if (connections_ != nullptr) connections_->OnJobDone(peer, pending_before, run->closed());
}

size_t ServiceCore::calls() const {
  MutexLock lock(mutex_);
  return runs_.size();
}

void ServiceCore::OnCall(const std::string& peer) {
  if (connections_ != nullptr) connections_->OnCall(peer);
}

void ServiceCore::OnCallDone(const std::string& peer) {
  if (connections_ != nullptr) connections_->OnCallDone(peer);
}

void ServiceCore::OnAuthorized(const std::string& peer) {
  if (connections_ != nullptr) connections_->OnAuthorized(peer);
}

void ServiceCore::OnMessage(const std::string& peer, int64_t bytes) {
  if (connections_ != nullptr) connections_->OnMessage(peer, bytes);
}

bool ServiceCore::EndOversizeJob(const std::string& peer, Excess excess) {
  std::shared_ptr<JobRun> oldest;
  {
    MutexLock lock(mutex_);
    for (const auto& [key, call] : runs_) {
      if (call.peer != peer || !call.run->waits_for_message()) continue;
      if (oldest == nullptr || call.run->progress() < oldest->progress()) oldest = call.run;
    }
  }
  if (oldest == nullptr) return false;
  if (excess == Excess::kAddress) {
    admission.CountRefusal(Refusal::kCallerMemory);
    oldest->Abort(absl::ResourceExhaustedError(
        "unfinished messages of this address take too much of the server's memory; send fewer at a "
        "time"));
    return true;
  }
  admission.CountRefusal(Refusal::kMessage);
  oldest->Abort(absl::ResourceExhaustedError(absl::StrCat(
      "the message has more bytes than this server's limit of ", limits.max_message_bytes)));
  return true;
}

void ServiceCore::Watch(Connections* connections, int64_t max_memory) {
  connections_ = connections;
  max_memory_ = max_memory;
  if (max_memory == INT64_MAX) return;
  pool.LimitMemory(static_cast<int64_t>(kSearchShare * static_cast<double>(max_memory)));
  watch_memory_.emplace(max_memory, connections,
                        MemoryWatch::Hooks{.set_short =
                                               [this](bool is_short) {
                                                 admission.SetMemoryShort(is_short);
                                                 pool.SetMemoryShort(is_short);
                                               },
                                           .on_cut =
                                               [this] {
                                                 files.log->Event(JobLog::Level::kWarning,
                                                                  "connection_cut",
                                                                  {{"message", "memory is short"}});
                                               }});
}

void ServiceCore::AbortAll(const absl::Status& status) {
  for (const Call& call : Calls()) call.run->Abort(status);
}

std::string ServiceCore::MetricsText() {
  Metrics::Gauges gauges;
  gauges.queue_layers = static_cast<double>(queue_layers.load());
  gauges.queue_points = static_cast<double>(admission.queued_points());
  gauges.jobs_in_flight = admission.jobs();
  gauges.workers_busy = pool.busy();
  gauges.workers = pool.threads();
  gauges.workers_silent = watchdog_ ? watchdog_->silent() : 0;
  gauges.ready = admission.draining() ? 0 : 1;
  gauges.jobs_bytes = static_cast<double>(admission.held_bytes());
  gauges.max_memory_bytes = static_cast<double>(max_memory_);
  if (connections_ != nullptr) {
    gauges.receiving_bytes = static_cast<double>(connections_->pending_bytes());
    gauges.connections = connections_->open();
    gauges.connections_cut = static_cast<double>(connections_->cut());
  }
  gauges.log_lines_lost = static_cast<double>(files.log->lost_lines());
  if (files.certificates != nullptr) {
    const std::shared_ptr<const CertificateSet> set = files.certificates->current();
    const absl::Time now = absl::Now();
    gauges.certificate_expiry_seconds = absl::ToDoubleSeconds(set->expiry - now);
    if (!set->client_ca.empty()) {
      gauges.client_ca_expiry_seconds = absl::ToDoubleSeconds(set->ca_expiry - now);
    }
  }
  return metrics.Text(gauges);
}

}  // namespace traverse
