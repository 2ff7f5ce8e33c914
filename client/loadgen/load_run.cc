#include "client/loadgen/load_run.h"

#include <grpcpp/client_context.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/client_callback.h>

#include <cassert>
#include <chrono>
#include <deque>
#include <string>
#include <thread>
#include <utility>

#include "absl/status/status.h"
#include "engine/base/mutex.h"

namespace traverse::loadgen {
namespace {

using Clock = std::chrono::steady_clock;

constexpr char kMethod[] = "/traverse.v1.RouteOptimizerService/OptimizeBatch";

Clock::duration ToChrono(absl::Duration duration) {
  return std::chrono::duration_cast<Clock::duration>(absl::ToChronoNanoseconds(duration));
}

// What all jobs of a run share. Thread-safe.
class Run {
 public:
  Run(const LoadOptions& options, const std::vector<JobKind>& kinds) : options_(options) {
    result_.ok.resize(kinds.size());
    result_.sent.resize(kinds.size());
    result_.duration = options.duration;
  }

  const LoadOptions& options() const { return options_; }

  // False if too many jobs are in flight; the job is then not sent.
  bool Begin(size_t kind, Clock::time_point meant, bool counted) {
    MutexLock lock(mutex_);
    if (counted) ++result_.sent[kind];
    if (in_flight_ >= options_.max_in_flight) {
      if (counted) ++result_.not_sent;
      return false;
    }
    ++in_flight_;
    if (counted) result_.send_lag.Record(absl::FromChrono(Clock::now() - meant));
    return true;
  }

  void End(size_t kind, absl::Duration latency, absl::Duration from_sent,
           const grpc::Status& status, bool complete, bool counted) {
    MutexLock lock(mutex_);
    --in_flight_;
    // Within the lock: the run may be destroyed as soon as the last job is counted.
    changed_.NotifyAll();
    if (!counted) return;
    if (status.ok() && complete) {
      result_.ok[kind].Add(latency, from_sent);
      result_.code["OK"].Add(latency, from_sent);
      return;
    }
    const std::string code =
        status.ok() ? "INCOMPLETE"
                    : absl::StatusCodeToString(static_cast<absl::StatusCode>(status.error_code()));
    result_.code[code].Add(latency, from_sent);
    result_.example.emplace(code, status.error_message());
  }

  void WaitUntilFewerThan(int jobs) {
    MutexLock lock(mutex_);
    while (in_flight_ >= jobs) changed_.Wait(mutex_);
  }

  LoadResult& result() { return result_; }

 private:
  const LoadOptions& options_;
  Mutex mutex_;
  ConditionVariable changed_;
  int in_flight_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  LoadResult result_;
};

// One job; deletes itself at the end.
class Job : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  Job(Run& run, const JobKind& kind, size_t position, Clock::time_point meant, bool counted)
      : run_(run),
        request_(kind.bytes),
        position_(position),
        answers_left_(kind.share.layers + 1),  // and the summary
        meant_(meant),
        counted_(counted) {}

  void Start(grpc::GenericStub& stub) {
    const LoadOptions& options = run_.options();
    context_.set_deadline(std::chrono::system_clock::now() +
                          absl::ToChronoNanoseconds(options.deadline));
    if (!options.token.empty()) context_.AddMetadata("authorization", "Bearer " + options.token);
    context_.AddMetadata("traverse-message-bytes", std::to_string(request_.Length()));
    sent_ = Clock::now();
    stub.PrepareBidiStreamingCall(&context_, kMethod, {}, this);
    StartWriteLast(&request_, grpc::WriteOptions());
    StartRead(&answer_);
    StartCall();
  }

  void OnReadDone(bool ok) override {
    if (!ok) return;
    --answers_left_;
    StartRead(&answer_);
  }

  void OnDone(const grpc::Status& status) override {
    Run& run = run_;
    const size_t position = position_;
    const Clock::time_point now = Clock::now();
    const absl::Duration latency = absl::FromChrono(now - meant_);
    const absl::Duration from_sent = absl::FromChrono(now - sent_);
    const bool complete = answers_left_ == 0;
    const bool counted = counted_;
    // Before the job is counted: the context holds the channel, and once the last job is counted
    // the caller may release its channel. This thread, one of the channel's own, would then be the
    // last owner, and gRPC aborts when it closes its queue from there.
    delete this;
    run.End(position, latency, from_sent, status, complete, counted);
  }

 private:
  Run& run_;
  const grpc::ByteBuffer request_;
  const size_t position_;
  int answers_left_;
  const Clock::time_point meant_;
  Clock::time_point sent_;
  const bool counted_;
  grpc::ClientContext context_;
  grpc::ByteBuffer answer_;
};

// Starts jobs, whose sizes and channels it chooses in turn.
class Starter {
 public:
  Starter(Run& run, const std::vector<JobKind>& kinds,
          const std::vector<std::shared_ptr<grpc::Channel>>& channels)
      : run_(run), kinds_(kinds), sizes_(Shares(kinds), run.options().seed) {
    for (const auto& channel : channels) stubs_.emplace_back(channel);
  }

  void Start(Clock::time_point meant, bool counted) {
    const size_t kind = sizes_.Next();
    if (!run_.Begin(kind, meant, counted)) return;
    auto* job = new Job(run_, kinds_[kind], kind, meant, counted);
    job->Start(stubs_[next_stub_++ % stubs_.size()]);
  }

 private:
  static std::vector<SizeShare> Shares(const std::vector<JobKind>& kinds) {
    std::vector<SizeShare> shares;
    for (const JobKind& kind : kinds) shares.push_back(kind.share);
    return shares;
  }

  Run& run_;
  const std::vector<JobKind>& kinds_;
  SizeChoice sizes_;
  std::deque<grpc::GenericStub> stubs_;
  size_t next_stub_ = 0;
};

}  // namespace

LoadResult RunLoad(const LoadOptions& options, const std::vector<JobKind>& kinds,
                   const std::vector<std::shared_ptr<grpc::Channel>>& channels) {
  assert(!kinds.empty() && !channels.empty());
  Run run(options, kinds);
  Starter starter(run, kinds, channels);
  const absl::Duration all = options.warm_up + options.duration;
  const Clock::time_point began = Clock::now();
  const Clock::time_point count_from = began + ToChrono(options.warm_up);
  if (options.rate > 0) {
    for (const absl::Duration at : SendTimes(options.rate, all, options.arrivals, options.seed)) {
      const Clock::time_point meant = began + ToChrono(at);
      std::this_thread::sleep_until(meant);
      starter.Start(meant, meant >= count_from);
    }
  } else {
    while (Clock::now() < began + ToChrono(all)) {
      run.WaitUntilFewerThan(options.in_flight);
      const Clock::time_point now = Clock::now();
      starter.Start(now, now >= count_from);
    }
  }
  run.WaitUntilFewerThan(1);
  return std::move(run.result());
}

}  // namespace traverse::loadgen
