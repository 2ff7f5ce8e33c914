#include "server/rpc/job_stream.h"

#include <grpc/grpc.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <functional>
#include <utility>

#include "server/jobs/return_margin.h"
#include "server/rpc/grpc_status.h"
#include "server/rpc/wire.h"

namespace traverse {
namespace {

using Clock = Budget::Clock;

// Layers freed at one go, when a job ends early.
constexpr size_t kDiscardedAtOnce = 64;

void DiscardSome(const std::shared_ptr<std::deque<LabelledLayer>>& layers,
                 const std::shared_ptr<WorkerPool::Queue>& queue) {
  layers->resize(layers->size() - std::min(layers->size(), kDiscardedAtOnce));
  if (!layers->empty()) queue->Submit([layers, queue] { DiscardSome(layers, queue); });
}

// Whether nothing but the call's deadline cuts the search short.
bool OnlyDeadlineLimits(const JobSetup& setup) {
  return setup.time_limit == absl::InfiniteDuration() &&
         setup.spec.layer_time_limit == absl::InfiniteDuration();
}

// Cancels the call, even if gRPC is done with it. Its context may then be gone.
std::function<void()> Canceller(grpc::CallbackServerContext& context) {
  grpc_call_ref(context.c_call());
  const std::shared_ptr<grpc_call> call(context.c_call(), grpc_call_unref);
  return [call] { grpc_call_cancel(call.get(), nullptr); };
}

}  // namespace

JobStream::JobStream(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call)
    : core_(core), context_(context), call_(std::move(call)) {
  core_.OnCall(call_.peer);
}

JobStream::~JobStream() {
  if (run_ != nullptr) core_.Unregister(run_, call_.peer);
  core_.OnCallDone(call_.peer);
}

absl::Status JobStream::Admit(const absl::Status& authorized, int64_t points) {
  if (authorized.ok()) core_.OnAuthorized(call_.peer);
  if (!authorized.ok()) {
    core_.admission.CountRefusal(absl::IsUnauthenticated(authorized) ? Refusal::kUnauthenticated
                                                                     : Refusal::kPermission);
    return authorized;
  }
  absl::StatusOr<std::unique_ptr<Admission::Ticket>> ticket =
      core_.admission.Admit(call_.caller, points, call_.deadline);
  if (!ticket.ok()) return ticket.status();
  ticket_ = *std::move(ticket);
  // A header may lie: it is checked, but reserves nothing.
  ticket_->Resize(0).IgnoreError();
  run_ = JobRun::Make(*this);
  queue_ = core_.pool.NewQueue(call_.caller, [run = run_] { run->Abort(NoMemory()); });
  ticket_->WatchWork([queue = queue_] { return !queue->idle(); });
  core_.Register(run_, call_.peer, Canceller(context_));
  return absl::OkStatus();
}

absl::Status JobStream::Begin(const v1::JobOptions& options) {
  absl::StatusOr<JobSetup> setup = JobFromProto(options);
  if (!setup.ok()) {
    setup_.job_id = Beginning(options.job_id(), 256);  // for the log
    AnnounceJob();
    return setup.status();
  }
  setup_ = *std::move(setup);
  if (setup_.strategy->traits().chain_bounding != StrategyTraits::ChainBounding::kNone)
    kept_plans_.emplace();
  AnnounceJob();
  queue_->set_job(setup_.job_id);
  layer_metrics_ = &core_.metrics.ForStrategy(setup_.strategy_name);
  return ticket_->SetStrategy(setup_.strategy_name);
}

void JobStream::AnnounceJob() {
  if (setup_.job_id.empty()) setup_.job_id = NewJobId();
  context_.AddInitialMetadata("job_id", MetadataText(setup_.job_id));
}

absl::Status JobStream::Resize(int64_t points) {
  assert(ticket_ != nullptr);
  admitted_points_ = points;
  return ticket_->Resize(points);
}

void JobStream::StartEngine(int64_t expected_layers, int64_t expected_points) {
  if (setup_.validate_only) return;
  std::optional<Clock::time_point> end;
  if (call_.deadline) {
    const Clock::time_point now = Clock::now();
    const auto due_before = static_cast<int64_t>(ticket_->PointsDueBefore());
    end = *call_.deadline - MarginOfReturn({.left = *call_.deadline - now,
                                            .layers = expected_layers,
                                            .points = expected_points + due_before,
                                            .lag = core_.return_lag.Margin(call_.caller),
                                            .wakings = core_.wake_lateness.Margin()});
    search_end_ = end;
  }
  if (setup_.time_limit != absl::InfiniteDuration()) {
    const Clock::time_point limit =
        call_.start + std::chrono::duration_cast<Clock::duration>(
                          absl::ToChronoNanoseconds(std::min(setup_.time_limit, absl::Hours(1e5))));
    end = end ? std::min(*end, limit) : limit;
  }
  setup_.spec.deadline = end;
  if (search_end_) queue_->set_due(*search_end_);
  run_->Start({core_.limits.window, setup_.build_order}, setup_.spec, std::move(setup_.strategy),
              *queue_);
}

void JobStream::AddLayers(std::vector<LabelledLayer> layers) {
  int64_t points = 0;
  for (const LabelledLayer& layer : layers) points += layer.label.points;
  // At the end of a message whatever was admitted too much is given back.
  const bool last = reader_.left() == 0;
  const int64_t admitted = last ? admitted_points_ : std::min(points, admitted_points_);
  admitted_points_ -= admitted;
  layers_received_ += layers.size();
  points_received_ += points;
  if (setup_.validate_only) return;
  ticket_->Add(points - admitted);
  const auto faulty = std::count_if(layers.begin(), layers.end(), [](const LabelledLayer& layer) {
    return !layer.label.fault.empty();
  });
  layers_queued_ += layers.size() - static_cast<uint64_t>(faulty);
  core_.queue_layers += static_cast<int64_t>(layers.size()) - faulty;
  for (LabelledLayer& layer : layers) run_->Add(std::move(layer));
}

void JobStream::Discard(std::deque<LabelledLayer> layers) {
  // Without the memory for it they are freed here and now.
  Guarded([&] {
    // A function may be copied, and layers are not to be.
    const auto left = std::make_shared<std::deque<LabelledLayer>>(std::move(layers));
    queue_->Submit([left, queue = queue_] { DiscardSome(left, queue); });
    return absl::OkStatus();
  }).IgnoreError();
}

void JobStream::OnCallCancelled() {
  if (run_ == nullptr) return;
  const bool late = call_.deadline && Clock::now() >= *call_.deadline;
  queue_->set_due(Clock::now());
  run_->Abort(late ? absl::DeadlineExceededError("the deadline of the call has passed")
                   : absl::CancelledError("the caller cancelled the call"));
}

// The plans that the engine keeps for a bound of the chain need memory until the job ends.
int64_t JobStream::BytesFreedBy(const LayerOutcome& outcome, const LayerLabel& label) {
  kept_bytes_ += label.bytes;
  return kept_plans_ && kept_plans_->Add(outcome.plan) ? 0 : std::exchange(kept_bytes_, 0);
}

std::string JobStream::EncodeLayer(const LayerOutcome& outcome, const LayerLabel& label) {
  totals_.Add(outcome);
  core_.metrics.CountLayer(*layer_metrics_, outcome, setup_.idle_speed_mm_s);
  const double busy_seconds = queue_->busy_seconds();
  ticket_->Remove(label.points, BytesFreedBy(outcome, label), busy_seconds - counted_seconds_,
                  outcome.stop == StopReason::kTimeLimit && OnlyDeadlineLimits(setup_));
  counted_seconds_ = busy_seconds;
  --core_.queue_layers;
  std::string message = Encode(outcome, label.id);
  ticket_->KeepAnswer(static_cast<int64_t>(message.size()));
  return message;
}

std::string JobStream::EncodeFault(const LayerLabel& label) {
  ++faulty_layers_;
  ticket_->LetGo(label.bytes);
  v1::LayerResult result;
  result.set_index(label.index);
  result.set_id(label.id);
  result.set_fault(label.fault);
  std::string message = Encode(result);
  ticket_->KeepAnswer(static_cast<int64_t>(message.size()));
  return message;
}

std::string JobStream::EncodeSummary() {
  v1::JobSummary summary;
  summary.set_faulty_layers(faulty_layers_);
  summary.set_job_id(setup_.job_id);
  summary.set_strategy(setup_.strategy_name);
  totals_.ToProto(setup_.idle_speed_mm_s, summary);
  summary.set_wall_seconds(WallSeconds());
  std::string message = Encode(summary);
  ticket_->KeepAnswer(static_cast<int64_t>(message.size()));
  return message;
}

const grpc::ByteBuffer* JobStream::Outgoing(const std::string& message) {
  outgoing_ = ToByteBuffer(message);
  return &outgoing_;
}

void JobStream::AnswerWritten(bool ok) {
  ticket_->LetGoAnswer(static_cast<int64_t>(outgoing_.Length()));
  outgoing_.Clear();
  run_->OnWriteDone(ok);
}

double JobStream::WallSeconds() const {
  return std::chrono::duration<double>(Clock::now() - call_.start).count();
}

JobRecord JobStream::Record(const absl::Status& status) const {
  JobRecord record;
  record.job_id = setup_.job_id;
  record.method = call_.method;
  record.caller = call_.caller;
  record.peer = call_.peer;
  record.trace_id = call_.trace_id;
  record.strategy = layer_metrics_ != nullptr ? setup_.strategy_name : Metrics::kUnknownStrategy;
  record.layers_received = layers_received_;
  record.layers = totals_.layers();
  record.points = points_received_;
  record.queue_seconds = queue_ != nullptr ? queue_->wait().first_seconds : 0;
  record.compute_seconds = totals_.compute_seconds();
  record.wall_seconds = WallSeconds();
  record.travel_given_mm = totals_.given_mm();
  record.travel_mm = totals_.travel_mm();
  record.idle_seconds_saved = (totals_.given_mm() - totals_.travel_mm()) / setup_.idle_speed_mm_s;
  record.invalid_routes = totals_.invalid_routes();
  record.status = status;
  return record;
}

void JobStream::End(const absl::Status& status) {
  const JobRecord record = Record(status);
  core_.queue_layers -= static_cast<int64_t>(layers_queued_ - totals_.layers());
  core_.metrics.CountJob(record.strategy, status.code(), record.wall_seconds);
  core_.metrics.CountRpc(call_.method, status.code());
  core_.files.log->Job(record);
  if (const Clock::time_point now = Clock::now(); search_end_ && now > *search_end_) {
    core_.return_lag.Record(call_.caller, now - *search_end_);
    ticket_->NoteLag(std::chrono::duration<double>(now - *search_end_).count());
  }
  // Before the caller learns of the end: its next job may need the place.
  ticket_.reset();
  FinishCall(ToGrpcStatus(status));
}

}  // namespace traverse
