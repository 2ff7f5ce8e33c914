#include "server/job_stream.h"

#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/grpc_status.h"

namespace traverse {
namespace {

using Clock = Budget::Clock;

// The way back of the last results takes part of the deadline: a share of the time, within bounds,
// and something for each layer and point that is known to come, as even a layer whose time has run
// out is given a greedy route, validated and written; at least what it took of late (return_lag.h).
// But never more than half.
constexpr double kMarginShare = 0.1;
constexpr auto kMinMargin = std::chrono::milliseconds(10);
constexpr auto kMaxMargin = std::chrono::milliseconds(500);
constexpr auto kMarginPerLayer = std::chrono::microseconds(100);
constexpr auto kMarginPerPoint = std::chrono::nanoseconds(500);

Clock::duration Margin(Clock::duration left, int64_t layers, int64_t points,
                       Clock::duration measured) {
  const auto share = std::chrono::duration_cast<Clock::duration>(left * kMarginShare);
  const Clock::duration base =
      std::max(std::clamp<Clock::duration>(share, kMinMargin, kMaxMargin), measured);
  return std::min<Clock::duration>(left / 2,
                                   base + layers * kMarginPerLayer + points * kMarginPerPoint);
}

std::string NewJobId() {
  std::random_device random;
  return absl::StrFormat("%08x%08x", random(), random());
}

absl::Status OverLimit(const std::string& place, int64_t found, const char* what, int64_t limit) {
  return absl::ResourceExhaustedError(
      absl::StrCat(place, ": ", found, " ", what, ", more than this server's limit of ", limit));
}

}  // namespace

JobStream::JobStream(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call)
    : core_(core), context_(context), call_(std::move(call)) {}

JobStream::~JobStream() {
  if (run_ != nullptr) core_.Unregister(run_);
}

absl::Status JobStream::Admit(const absl::Status& authorized, int64_t points) {
  if (!authorized.ok()) {
    core_.admission.CountRefusal(absl::IsUnauthenticated(authorized) ? Refusal::kUnauthenticated
                                                                     : Refusal::kPermission);
    return authorized;
  }
  absl::StatusOr<std::unique_ptr<Admission::Ticket>> ticket =
      core_.admission.Admit(call_.caller, points);
  if (!ticket.ok()) return ticket.status();
  ticket_ = *std::move(ticket);
  run_ = JobRun::Make(*this);
  queue_ = core_.pool.NewQueue(call_.caller, [run = run_] { run->Abort(NoMemory()); });
  core_.Register(run_);
  return absl::OkStatus();
}

absl::Status JobStream::Begin(const v1::JobOptions& options) {
  absl::StatusOr<JobSetup> setup = JobFromProto(options);
  if (!setup.ok()) {
    setup_.job_id = options.job_id().substr(0, 256);  // for the log
    return setup.status();
  }
  setup_ = *std::move(setup);
  if (setup_.job_id.empty()) setup_.job_id = NewJobId();
  layer_metrics_ = &core_.metrics.ForStrategy(setup_.strategy_name);
  return absl::OkStatus();
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
  for (const v1::PlanNode& node : layer.plan().nodes()) pairs += node.any_order().before_size();
  const int64_t parts =
      std::max<int64_t>(pairs, std::max<int64_t>(layer.islands_size(), layer.plan().nodes_size()));
  if (parts / 4 > limit) {
    core_.admission.CountRefusal(Refusal::kLayerPoints);
    return OverLimit(place, parts, "islands, nodes or pairs", 4 * limit);
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<LabelledLayer>> JobStream::Translate(
    const google::protobuf::RepeatedPtrField<v1::Layer>& layers) const {
  const JobLimits& limits = core_.limits;
  if (layers.size() > limits.max_layers_per_message) {
    core_.admission.CountRefusal(Refusal::kJobLayers);
    return OverLimit("layers", layers.size(), "layers in a message", limits.max_layers_per_message);
  }
  const uint64_t total = layers_received_ + static_cast<uint64_t>(layers.size());
  if (limits.max_layers_per_job > 0 && total > static_cast<uint64_t>(limits.max_layers_per_job)) {
    core_.admission.CountRefusal(Refusal::kJobLayers);
    return OverLimit("layers", static_cast<int64_t>(total), "layers", limits.max_layers_per_job);
  }
  std::vector<LabelledLayer> translated;
  translated.reserve(static_cast<size_t>(layers.size()));
  int64_t points = points_received_;
  for (const v1::Layer& layer : layers) {
    const uint64_t index = layers_received_ + translated.size();
    const int64_t layer_points = CountPoints(layer);
    if (absl::Status status = CheckSize(layer, index, layer_points); !status.ok()) return status;
    absl::StatusOr<LabelledLayer> value = LayerFromProto(layer, index, setup_.interleaved);
    if (!value.ok()) return value.status();
    value->points = std::max<int64_t>(1, layer_points);
    points += value->points;
    if (limits.max_points_per_job > 0 && points > limits.max_points_per_job) {
      core_.admission.CountRefusal(Refusal::kJobPoints);
      return OverLimit(absl::StrCat("layers[", index, "]"), points, "points up to here",
                       limits.max_points_per_job);
    }
    translated.push_back(*std::move(value));
  }
  return translated;
}

void JobStream::StartEngine(int64_t expected_layers, int64_t expected_points) {
  std::optional<Clock::time_point> end;
  if (call_.deadline) {
    const Clock::time_point now = Clock::now();
    end = *call_.deadline - Margin(*call_.deadline - now, expected_layers, expected_points,
                                   core_.return_lag.Margin());
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

void JobStream::AddLayers(std::vector<LabelledLayer> layers, int64_t admitted_points) {
  int64_t points = 0;
  for (const LabelledLayer& layer : layers) points += layer.points;
  ticket_->Add(points - admitted_points);
  layers_received_ += layers.size();
  points_received_ += points;
  core_.queue_layers += static_cast<int64_t>(layers.size());
  for (LabelledLayer& layer : layers) run_->Add(std::move(layer));
  run_->Push();
}

void JobStream::OnCallCancelled() {
  if (run_ == nullptr) return;
  const bool late = call_.deadline && Clock::now() >= *call_.deadline;
  run_->Abort(late ? absl::DeadlineExceededError("the deadline of the call has passed")
                   : absl::CancelledError("the caller cancelled the call"));
}

std::string JobStream::EncodeLayer(const LayerOutcome& outcome, uint64_t id, int64_t points) {
  totals_.Add(outcome);
  core_.metrics.CountLayer(*layer_metrics_, outcome, setup_.idle_speed_mm_s);
  const double busy_seconds = queue_->busy_seconds();
  ticket_->Remove(points, busy_seconds - counted_seconds_);
  counted_seconds_ = busy_seconds;
  --core_.queue_layers;
  return Encode(outcome, id);
}

std::string JobStream::EncodeSummary() {
  v1::JobSummary summary;
  summary.set_job_id(setup_.job_id);
  summary.set_strategy(setup_.strategy_name);
  totals_.ToProto(setup_.idle_speed_mm_s, summary);
  summary.set_wall_seconds(WallSeconds());
  return Encode(summary);
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
  core_.queue_layers -= static_cast<int64_t>(layers_received_ - totals_.layers());
  core_.metrics.CountJob(record.strategy, status.code(), record.wall_seconds);
  core_.metrics.CountRpc(call_.method, status.code());
  core_.log->Job(record);
  if (const Clock::time_point now = Clock::now(); search_end_ && now > *search_end_) {
    core_.return_lag.Record(now - *search_end_);
  }
  // Before the caller hears of the end: his next job may need the place.
  ticket_.reset();
  FinishCall(ToGrpcStatus(status));
}

}  // namespace traverse
