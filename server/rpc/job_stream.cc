#include "server/rpc/job_stream.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "engine/base/rest.h"
#include "server/jobs/return_margin.h"
#include "server/rpc/grpc_status.h"
#include "server/rpc/wire.h"

namespace traverse {
namespace {

using Clock = Budget::Clock;

// Messages up to this size are read on gRPC's own thread; a reaction must be
// quick.
constexpr size_t kReadHereBytes = 32 << 10;

// How much of a larger one is read at once: about a millisecond's work.
constexpr int64_t kPieceBytes = 64 << 10;

// Layers freed at one go, when a job ends early.
constexpr size_t kDiscardedAtOnce = 64;

absl::Status OverLimit(const std::string& place, int64_t found, const char* what, int64_t limit) {
  return absl::ResourceExhaustedError(
      absl::StrCat(place, ": ", found, " ", what, ", more than this server's limit of ", limit));
}

void DiscardSome(const std::shared_ptr<std::deque<LabelledLayer>>& layers,
                 const std::shared_ptr<WorkerPool::Queue>& queue) {
  layers->resize(layers->size() - std::min(layers->size(), kDiscardedAtOnce));
  if (!layers->empty()) queue->Submit([layers, queue] { DiscardSome(layers, queue); });
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
  core_.Register(run_, call_.peer);
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

absl::Status JobStream::CheckSize(const v1::Layer& layer, uint64_t index, int64_t points) const {
  const std::string place = absl::StrCat("layers[", index, "]");
  const int64_t limit = core_.limits.max_points_per_layer;
  if (points > limit) {
    core_.admission.CountRefusal(Refusal::kLayerPoints);
    return OverLimit(place, points, "points", limit);
  }
  // Islands, nodes and pairs may be empty, but they take memory all the same.
  int64_t pairs = 0;
  Budget turns(nullptr, std::nullopt, queue_->turn());
  Rest rest(&turns);
  for (const v1::PlanNode& node : layer.plan().nodes()) {
    rest(8);
    pairs += node.any_order().before_size();
  }
  const int64_t parts =
      std::max<int64_t>(pairs, std::max<int64_t>(layer.islands_size(), layer.plan().nodes_size()));
  if (parts / 4 > limit) {
    core_.admission.CountRefusal(Refusal::kLayerPoints);
    return OverLimit(place, parts, "islands, nodes or pairs", 4 * limit);
  }
  return absl::OkStatus();
}

absl::Status JobStream::CheckLayerCount(int64_t more) const {
  const JobLimits& limits = core_.limits;
  const int64_t total = layers_received() + more;
  if (more > limits.max_layers_per_message) {
    core_.admission.CountRefusal(Refusal::kJobLayers);
    return OverLimit("layers", more, "layers in a message", limits.max_layers_per_message);
  }
  if (limits.max_layers_per_job > 0 && total > limits.max_layers_per_job) {
    core_.admission.CountRefusal(Refusal::kJobLayers);
    return OverLimit("layers", total, "layers", limits.max_layers_per_job);
  }
  return absl::OkStatus();
}

absl::StatusOr<LabelledLayer> JobStream::Translate(const v1::Layer& layer, uint64_t index) const {
  Budget turns(nullptr, std::nullopt, queue_->turn());
  const int64_t points = CountPoints(layer, &turns);
  if (absl::Status status = CheckSize(layer, index, points); !status.ok()) return status;
  absl::StatusOr<LabelledLayer> value = LayerFromProto(layer, index, setup_.interleaved, &turns);
  if (!value.ok()) return value;
  value->label.points = std::max<int64_t>(1, points);
  value->label.bytes = reader_.layer_footprint_bytes();
  return value;
}

absl::Status JobStream::Resize(int64_t points) {
  assert(ticket_ != nullptr);
  admitted_points_ = points;
  return ticket_->Resize(points);
}

void JobStream::ReadMessage(grpc::ByteBuffer& message) {
  const std::shared_ptr<JobRun> run = run_;
  if (!run->Hold()) return;  // the call was cancelled while its message came in
  opened_ = false;
  const auto bytes = static_cast<int64_t>(message.Length());
  core_.OnMessage(call_.peer, bytes);
  if (absl::Status status = CheckMessage(bytes); !status.ok()) {
    run->Abort(status);
    run->Release();
    return;
  }
  if (message.Length() > kReadHereBytes) return ReadPiecesInTurns(message);
  while (ReadPiece(message)) {
  }
  run->Release();  // may end the call
}

void JobStream::ReadPiecesInTurns(grpc::ByteBuffer& message) {
  const std::shared_ptr<JobRun> run = run_;
  const absl::Status submitted = Guarded([&] {
    queue_->Submit([this, &message, run] {
      if (ReadPiece(message)) return ReadPiecesInTurns(message);
      run->Release();  // may end the call
    });
    return absl::OkStatus();
  });
  if (submitted.ok()) return;
  run->Abort(submitted);
  run->Release();
}

bool JobStream::ReadPiece(grpc::ByteBuffer& message) {
  if (run_->aborted()) return false;
  const absl::Status status =
      Guarded([&] { return opened_ ? ReadLayers() : OpenMessage(message); });
  if (!status.ok()) {
    run_->Abort(status);
    return false;
  }
  if (reader_.left() > 0) return true;
  ticket_->LetGo(std::exchange(message_bytes_, 0));
  if (setup_.validate_only) ticket_->LetGo(reader_.footprint_bytes());
  OnMessageRead();
  return false;
}

// The bytes of the message count until it is read; the memory of its layers, while they are kept.
absl::Status JobStream::CheckMessage(int64_t bytes) {
  if (bytes > core_.limits.max_message_bytes) {
    core_.admission.CountRefusal(Refusal::kMessage);
    return OverLimit("the message", bytes, "bytes", core_.limits.max_message_bytes);
  }
  if (absl::Status status = ticket_->Hold(bytes); !status.ok()) return status;
  message_bytes_ = bytes;
  return absl::OkStatus();
}

absl::Status JobStream::OpenMessage(grpc::ByteBuffer& message) {
  const RequestLimits limits = {.parts_of_layer = 4 * core_.limits.max_points_per_layer,
                                .footprint_bytes = core_.limits.max_bytes_per_message,
                                .layers = core_.limits.max_layers_per_message};
  const auto goes_on = [this] {
    Budget(nullptr, std::nullopt, queue_->turn()).Exhausted();
    return !run_->aborted();
  };
  if (absl::Status status = reader_.Open(RequestType(), message, limits, goes_on); !status.ok()) {
    if (absl::IsResourceExhausted(status)) core_.admission.CountRefusal(Refusal::kLayerPoints);
    return status;
  }
  opened_ = true;
  faults_ = FaultList();
  if (absl::Status status = OnOptions(reader_); !status.ok()) {
    if (!FaultList::IsFault(status) || reader_.layers() == 0) return status;
    faults_.Add(status);  // also reports faults of the layers
  }
  if (absl::Status status = CheckLayerCount(reader_.layers()); !status.ok()) return status;
  return ticket_->Hold(reader_.footprint_bytes(), message_bytes_);
}

absl::Status JobStream::ReadLayers() {
  std::vector<LabelledLayer> layers;
  uint64_t faulty = 0;
  int64_t points = points_received_;
  const auto take = [&](const v1::Layer& message) -> absl::Status {
    const uint64_t index = layers_received_ + layers.size() + faulty;
    absl::StatusOr<LabelledLayer> layer = Translate(message, index);
    if (FaultList::IsFault(layer.status())) {
      faults_.Add(layer.status());
      ++faulty;
      return faults_.full() ? faults_.status() : absl::OkStatus();
    }
    if (!layer.ok()) return layer.status();
    points += layer->label.points;
    if (core_.limits.max_points_per_job > 0 && points > core_.limits.max_points_per_job) {
      core_.admission.CountRefusal(Refusal::kJobPoints);
      return OverLimit(absl::StrCat("layers[", index, "]"), points, "points up to here",
                       core_.limits.max_points_per_job);
    }
    layers.push_back(*std::move(layer));
    return absl::OkStatus();
  };
  if (absl::Status status = reader_.Read(kPieceBytes, take); !status.ok()) return status;
  if (!faults_.empty()) {
    layers_received_ += layers.size() + faulty;
    return reader_.left() == 0 ? faults_.status() : absl::OkStatus();
  }
  // Depends only on what was sent: pieces, and what has arrived, must not change a route.
  for (LabelledLayer& layer : layers) layer.layer.more_follows = true;
  if (reader_.left() == 0 && !layers.empty())
    layers.back().layer.more_follows = MoreFollowsMessage();
  AddLayers(std::move(layers));
  return absl::OkStatus();
}

void JobStream::StartEngine(int64_t expected_layers, int64_t expected_points) {
  if (setup_.validate_only) return;
  std::optional<Clock::time_point> end;
  if (call_.deadline) {
    const Clock::time_point now = Clock::now();
    end = *call_.deadline - MarginOfReturn({.left = *call_.deadline - now,
                                            .layers = expected_layers,
                                            .points = expected_points,
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
  layers_queued_ += layers.size();
  core_.queue_layers += static_cast<int64_t>(layers.size());
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
  ticket_->Remove(label.points, BytesFreedBy(outcome, label), busy_seconds - counted_seconds_);
  counted_seconds_ = busy_seconds;
  --core_.queue_layers;
  std::string message = Encode(outcome, label.id);
  ticket_->KeepAnswer(static_cast<int64_t>(message.size()));
  return message;
}

std::string JobStream::EncodeSummary() {
  v1::JobSummary summary;
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
  }
  // Before the caller learns of the end: its next job may need the place.
  if (ticket_ != nullptr) ticket_->NoteWait(queue_->wait().first_seconds);
  ticket_.reset();
  FinishCall(ToGrpcStatus(status));
}

}  // namespace traverse
