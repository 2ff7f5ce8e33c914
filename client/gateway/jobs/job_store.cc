#include "client/gateway/jobs/job_store.h"

#include <chrono>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/gateway/api/file_routes.h"
#include "client/gateway/core.h"

namespace traverse::gateway {
namespace {

// Proxies give up a connection on which nothing comes for a minute, many after 30 s.
constexpr int kSweepsBetweenReminders = 15;

absl::Status Expired() {
  return absl::AbortedError("this job has expired or was cancelled; send the file again");
}

}  // namespace

absl::StatusOr<std::unique_ptr<JobStore>> JobStore::Make(const JobLimits& limits, Core& core) {
  absl::StatusOr<JobIds> ids = JobIds::Make(limits.gateway_name);
  if (!ids.ok()) return ids.status();
  return std::unique_ptr<JobStore>(new JobStore(*std::move(ids), limits, core));
}

JobStore::JobStore(JobIds ids, const JobLimits& limits, Core& core)
    : ids_(std::move(ids)),
      limits_(limits),
      core_(core),
      shares_(limits.max_jobs),
      sweep_(std::chrono::seconds(1), [this] { Sweep(); }) {}

std::shared_ptr<Job> JobStore::Same(const JobWish& wish) const {
  if (wish.key.empty()) return nullptr;
  const auto found = keys_.find({wish.request.caller, wish.key});
  if (found == keys_.end() || found->second->may_be_tried_again()) return nullptr;
  return found->second;
}

absl::StatusOr<std::shared_ptr<Job>> JobStore::Add(JobWish wish) {
  const std::string caller = wish.request.caller;
  absl::StatusOr<std::string> id = ids_.New(caller);
  if (!id.ok()) return id.status();
  if (const auto refusal = shares_.Take(1, caller)) {
    return absl::ResourceExhaustedError(
        refusal->of_caller
            ? absl::StrCat("this caller may have ", refusal->most,
                           " jobs now, and has them; fetch results and delete them, or come again "
                           "later")
            : absl::StrCat("the gateway keeps ", refusal->most, " jobs at most; come again later"));
  }
  const std::string key = wish.key;
  auto job = std::make_shared<Job>(*id, std::move(wish));
  jobs_[*id] = job;
  if (!key.empty()) keys_[{caller, key}] = job;
  return job;
}

absl::StatusOr<std::shared_ptr<Job>> JobStore::Create(
    const std::shared_ptr<WorkQueue::Ticket>& ticket, JobWish wish) {
  std::shared_ptr<Job> job;
  const std::shared_ptr<const SpoolFile> upload = wish.upload;
  {
    MutexLock lock(mutex_);
    job = Same(wish);
    if (job != nullptr) {
      if (job->wish().print == wish.print) return job;
      return absl::AlreadyExistsError(
          "this idempotency key is that of another file, or of other options");
    }
    absl::StatusOr<std::shared_ptr<Job>> added = Add(std::move(wish));
    if (!added.ok()) return added.status();
    job = *std::move(added);
  }
  core_.Submit(ticket, {upload}, {job->wish().request.finish_by, job->cancelled()},
               [this, job](const absl::Status& may) { Run(*job, may); });
  return job;
}

void JobStore::Run(Job& job, const absl::Status& may) {
  const absl::Time began = absl::Now();
  const std::shared_ptr<const SpoolFile> upload = job.wish().upload;
  absl::StatusOr<RewrittenFile> made =
      may.ok()
          ? core_.worker->Rewrite(
                *upload, job.wish().request,
                [&job](const v1::RewriteProgress& now) { job.SetProgress(now); }, job.cancelled())
          : may;
  const JobWish& wish = job.wish();
  const FileRecord record = {wish.route,     job.caller(),
                             wish.peer,      wish.request.name,
                             upload->size(), absl::ToDoubleSeconds(absl::Now() - began)};
  RecordFile(core_, record, made.status(), made.ok() ? &made->summary : nullptr);
  job.End(made, absl::Now() + limits_.ttl);
}

absl::StatusOr<std::shared_ptr<Job>> JobStore::Find(const std::string& id,
                                                    const std::string& caller) const {
  if (absl::Status status = ids_.Check(id, caller); !status.ok()) return status;
  MutexLock lock(mutex_);
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) return Expired();
  return found->second;
}

void JobStore::Forget(const Job& job) {
  const auto key = keys_.find({job.caller(), job.wish().key});
  if (key != keys_.end() && key->second.get() == &job) keys_.erase(key);
  shares_.GiveBack(1, job.caller());
  jobs_.erase(job.id());
}

absl::Status JobStore::Cancel(const std::string& id, const std::string& caller) {
  absl::StatusOr<std::shared_ptr<Job>> job = Find(id, caller);
  if (!job.ok()) return job.status();
  {
    MutexLock lock(mutex_);
    if (!jobs_.contains(id)) return Expired();
    Forget(**job);
  }
  (*job)->Cancel(Expired());
  return absl::OkStatus();
}

void JobStore::CancelAll() {
  std::map<std::string, std::shared_ptr<Job>> all;
  {
    MutexLock lock(mutex_);
    all = jobs_;
  }
  for (const auto& [id, job] : all) {
    job->Cancel(absl::AbortedError("the gateway ends; send the file to another one"));
  }
}

int JobStore::unfetched() const {
  MutexLock lock(mutex_);
  int count = 0;
  for (const auto& [id, job] : jobs_) count += job->fetched() ? 0 : 1;
  return count;
}

void JobStore::Sweep() {
  const absl::Time now = absl::Now();
  const bool remind = ++sweeps_ % kSweepsBetweenReminders == 0;
  std::vector<std::shared_ptr<Job>> expired;  // their files are closed without the lock
  MutexLock lock(mutex_);
  for (const auto& [id, job] : jobs_) {
    if (job->expires() <= now) expired.push_back(job);
    if (remind) job->Remind();
  }
  for (const auto& job : expired) Forget(*job);
}

}  // namespace traverse::gateway
