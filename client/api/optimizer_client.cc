#include "client/api/optimizer_client.h"

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <random>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "absl/cleanup/cleanup.h"
#include "absl/status/status.h"
#include "absl/strings/cord.h"
#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/api/resume.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace traverse {
namespace {

using Stream = grpc::ClientReaderWriter<v1::OptimizeRequest, v1::OptimizeResponse>;

// Sends layers together up to this size: this costs less for small ones, and the first answers
// still come early.
constexpr size_t kMessageBytes = size_t{32} << 10;

absl::Status FromGrpc(const grpc::Status& status) {
  absl::Status out(static_cast<absl::StatusCode>(status.error_code()), status.error_message());
  google::rpc::Status details;
  if (status.ok() || !details.ParseFromString(status.error_details())) return out;
  for (const google::protobuf::Any& any : details.details()) {
    out.SetPayload(any.type_url(), absl::Cord(any.value()));
  }
  return out;
}

void SetDeadline(grpc::ClientContext& context, absl::Duration deadline) {
  if (deadline == absl::InfiniteDuration()) return;
  context.set_deadline(absl::ToChronoTime(absl::Now() + deadline));
}

// As OpenPath.points may be; of NaN not true.
bool MayBeSent(double mm) { return mm >= -1e6 && mm <= 1e6; }

// Keeps only the two ends of an open path, unless the service has something to refuse between them.
void Strip(v1::OpenPath& path) {
  const int n = path.points_size();
  if (n <= 4 || n % 2 != 0) return;  // the service refuses odd numbers
  auto& points = *path.mutable_points();
  if (!std::all_of(points.begin(), points.end(), MayBeSent)) return;
  points[2] = points[n - 2];
  points[3] = points[n - 1];
  points.Truncate(4);
}

v1::Layer Stripped(const v1::Layer& layer) {
  v1::Layer out = layer;
  for (v1::Island& island : *out.mutable_islands()) {
    for (v1::OpenPath& raster : *island.mutable_rasters()) Strip(raster);
  }
  if (!out.has_plan()) return out;
  for (v1::PlanPath& path : *out.mutable_plan()->mutable_paths()) {
    if (path.has_open_path()) Strip(*path.mutable_open_path());
  }
  return out;
}

// Sends the job, with `empty_layer` after its layers, then closes this half of the stream. A write
// fails when the call is over; Finish says why.
void Send(const v1::JobOptions& options, absl::Span<const v1::Layer> layers, bool empty_layer,
          Stream& stream) {
  v1::OptimizeRequest request;
  *request.mutable_options() = options;
  size_t bytes = 0;
  for (size_t i = 0; i < layers.size(); ++i) {
    v1::Layer& sent = *request.add_layers();
    sent = Stripped(layers[i]);
    bytes += sent.ByteSizeLong();
    const bool more = i + 1 < layers.size() || empty_layer;
    // It reads answers while it still sends. If one message is all, its last layer is the last one.
    if (request.has_options()) request.mutable_options()->set_look_ahead(more);
    if (bytes < kMessageBytes && more) continue;
    if (!stream.Write(request)) return;
    request.Clear();
    bytes = 0;
  }
  if (empty_layer) request.add_layers();
  if (request.has_options() || request.layers_size() > 0) {
    if (!stream.Write(request)) return;
  }
  stream.WritesDone();
}

// How long the server advises to wait before the next attempt, if it does.
std::optional<absl::Duration> RetryDelay(const grpc::Status& status) {
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) return std::nullopt;
  for (const google::protobuf::Any& any : details.details()) {
    google::rpc::RetryInfo info;
    if (any.UnpackTo(&info)) {
      return absl::Seconds(info.retry_delay().seconds()) +
             absl::Nanoseconds(info.retry_delay().nanos());
    }
  }
  return std::nullopt;
}

// Whether the call was lost on the way. Most losses are UNAVAILABLE. A connection that breaks at
// the wrong moment is also reported as CANCELLED (we never cancel while we wait for an answer),
// by gRPC itself as UNKNOWN, or by proxies in between as INTERNAL. The service sends none of
// these.
bool WasLost(const grpc::Status& status) {
  const auto begins = [&](const char* text) { return status.error_message().rfind(text, 0) == 0; };
  switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::CANCELLED:
      return true;
    case grpc::StatusCode::UNKNOWN:
      return begins("Stream removed");
    case grpc::StatusCode::INTERNAL:
      return begins("Received RST_STREAM") || begins("RST_STREAM");
    default:
      return false;
  }
}

// How long to wait after `attempts` failed attempts, or nothing if another one makes no sense.
std::optional<absl::Duration> DelayAfter(const grpc::Status& status, const RetryPolicy& policy,
                                         int attempts) {
  const std::optional<absl::Duration> advice = RetryDelay(status);
  const bool full = status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED && advice;
  if (!full && !WasLost(status)) return std::nullopt;
  if (attempts >= (full ? policy.max_refusals : policy.max_attempts)) return std::nullopt;
  absl::Duration delay = policy.first_delay;
  for (int i = 1; i < attempts; ++i) delay = std::min(delay * 2, policy.max_delay);
  delay = std::max(delay, advice.value_or(absl::ZeroDuration()));
  // So that callers that were refused together do not come back together.
  thread_local std::minstd_rand random(std::random_device{}());
  return delay * std::uniform_real_distribution<double>(1.0, 1.25)(random);
}

// Collects the answers of one job.
class Collector {
 public:
  Collector(absl::Span<const v1::Layer> layers, const CallOptions& call)
      : layers_(layers), call_(call) {
    result_.layers.resize(layers.size());
    answered_.resize(layers.size());
    for (size_t i = 0; i < call.known.size(); ++i) {
      if (!call.known[i]) continue;
      result_.layers[i] = *call.known[i];
      answered_[i] = true;
      ++answers_;
    }
  }

  // Takes an answer of a call for the layers of `run`.
  absl::Status Take(v1::OptimizeResponse response, const MissingRun& run) {
    if (response.has_summary()) {
      result_.summary = std::move(*response.mutable_summary());
      summary_ = true;
      return absl::OkStatus();
    }
    const uint64_t index = response.layer().index() + run.begin;
    if (response.has_layer() && index == run.end && index < layers_.size()) {
      return absl::OkStatus();  // the empty layer at the end of a run
    }
    if (!response.has_layer() || index >= layers_.size() || answered_[index]) {
      return absl::InternalError("the server answered a layer that was not asked for");
    }
    v1::LayerResult& layer = result_.layers[index];
    layer = std::move(*response.mutable_layer());
    layer.set_index(index);
    if (!layer.fault().empty()) return Note(index);
    if (const absl::Status status = CheckVisits(layers_[index], layer); !status.ok()) {
      return absl::InternalError(
          absl::StrFormat("the server's answer to layers[%d] is not a route: %s", index,
                          std::string(status.message())));
    }
    return Note(index);
  }

  // Whether a call for `run` that ended well has answered all of it.
  bool Complete(const MissingRun& run) const {
    return summary_ && std::find(answered_.begin() + static_cast<std::ptrdiff_t>(run.begin),
                                 answered_.begin() + static_cast<std::ptrdiff_t>(run.end),
                                 false) == answered_.begin() + static_cast<std::ptrdiff_t>(run.end);
  }

  const std::vector<bool>& answered() const { return answered_; }
  size_t answers() const { return answers_; }
  bool has_summary() const { return summary_; }
  JobResult& result() { return result_; }

 private:
  absl::Status Note(uint64_t index) {
    answered_[index] = true;
    ++answers_;
    if (call_.on_layer) call_.on_layer(result_.layers[index]);
    return absl::OkStatus();
  }

  const absl::Span<const v1::Layer> layers_;
  const CallOptions& call_;
  JobResult result_;
  std::vector<bool> answered_;
  size_t answers_ = 0;
  bool summary_ = false;
};

// Makes one call for the layers of `run`. Sets `fault` if an answer is malformed.
grpc::Status CallOnce(v1::RouteOptimizerService::Stub& stub, grpc::ClientContext& context,
                      const std::stop_token& cancel, const v1::JobOptions& options,
                      absl::Span<const v1::Layer> layers, const MissingRun& run,
                      Collector& collector, absl::Status& fault) {
  const std::unique_ptr<Stream> stream = stub.Optimize(&context);
  const std::stop_callback on_cancel(cancel, [&] { context.TryCancel(); });
  // A cleaning after the last layer happens only if another layer follows.
  const bool empty_layer =
      run.end < layers.size() && CleaningDueAfter(options, run.end - run.begin - 1);
  bool sent = true;
  const auto send = [&] {
    try {
      Send(options, layers.subspan(run.begin, run.end - run.begin), empty_layer, *stream);
    } catch (const std::bad_alloc&) {
      sent = false;
      context.TryCancel();
    }
  };
  std::jthread sender;
  absl::Cleanup give_up = [&context] { context.TryCancel(); };  // lets the sender end
  try {
    sender = std::jthread(send);
  } catch (const std::system_error&) {  // the process may have no more threads
    sent = false;
    context.TryCancel();
  }
  v1::OptimizeResponse response;
  while (stream->Read(&response)) {
    fault = collector.Take(std::move(response), run);
    if (!fault.ok()) {
      context.TryCancel();
      break;
    }
    response.Clear();
  }
  // When the server has ended the call, a write that waits for room returns.
  std::move(give_up).Cancel();
  if (sender.joinable()) sender.join();
  const grpc::Status status = stream->Finish();
  if (sent) return status;
  return {grpc::StatusCode::UNAVAILABLE, "there is no memory or no thread to send the job with"};
}

// False if `cancel` came first.
bool SleepUnlessCancelled(absl::Duration delay, const std::stop_token& cancel) {
  std::mutex mutex;
  std::condition_variable_any cancelled;
  std::unique_lock<std::mutex> lock(mutex);
  return !cancelled.wait_for(lock, cancel, absl::ToChronoNanoseconds(delay),
                             [&] { return cancel.stop_requested(); });
}

}  // namespace

OptimizerClient::OptimizerClient(std::shared_ptr<grpc::Channel> channel, std::string token)
    : stub_(v1::RouteOptimizerService::NewStub(std::move(channel))), token_(std::move(token)) {}

void OptimizerClient::Authorize(grpc::ClientContext& context) const {
  if (!token_.empty()) context.AddMetadata("authorization", "Bearer " + token_);
}

absl::StatusOr<JobResult> OptimizerClient::Optimize(const v1::JobOptions& options,
                                                    absl::Span<const v1::Layer> layers,
                                                    const CallOptions& call) {
  const absl::Time began = absl::Now();
  const absl::Time deadline = began + call.deadline;
  Collector collector(layers, call);
  int in_vain = 0;
  int calls = 0;
  do {
    const MissingRun run = FirstMissing(collector.answered());
    // Layers with a fault do not move the head.
    const v1::LayerResult* before = nullptr;
    size_t printed = 0;
    for (size_t i = 0; i < run.begin; ++i) {
      const v1::LayerResult& layer = collector.result().layers[i];
      if (!layer.fault().empty()) continue;
      before = &layer;
      ++printed;
    }
    const size_t had = collector.answers();
    absl::Status fault;
    grpc::ClientContext context;
    Authorize(context);
    if (deadline != absl::InfiniteFuture()) context.set_deadline(absl::ToChronoTime(deadline));
    const grpc::Status status = CallOnce(
        *stub_, context, call.cancel, ResumedOptions(options, printed, before, absl::Now() - began),
        layers, run, collector, fault);
    ++calls;
    if (!fault.ok()) return fault;
    if (call.cancel.stop_requested()) return absl::CancelledError("cancelled");
    in_vain = collector.answers() > had ? 1 : in_vain + 1;
    if (status.ok()) {
      if (!collector.Complete(run)) {
        return absl::InternalError(absl::StrFormat("the server answered %d of %d layers",
                                                   collector.answers(), layers.size()));
      }
      continue;
    }
    if (collector.answers() == layers.size() && !layers.empty()) break;  // only the summary is lost
    const std::optional<absl::Duration> delay = DelayAfter(status, call.retry, in_vain);
    if (!delay || absl::Now() + *delay >= deadline) {
      const absl::Status failure = FromGrpc(status);
      if (run.begin == 0) return failure;
      absl::Status shifted(failure.code(), ShiftPlace(std::string(failure.message()), run.begin));
      // But for its fields, whose places are those of the last call.
      failure.ForEachPayload([&shifted](absl::string_view url, const absl::Cord& detail) {
        if (!absl::EndsWith(url, ".BadRequest")) shifted.SetPayload(url, detail);
      });
      return shifted;
    }
    if (!SleepUnlessCancelled(*delay, call.cancel)) return absl::CancelledError("cancelled");
  } while (collector.answers() < layers.size());
  if (calls > 1 || !collector.has_summary() || !call.known.empty()) {
    JobResult& result = collector.result();
    result.summary = SummaryOf(options, result.layers, result.summary,
                               absl::ToDoubleSeconds(absl::Now() - began));
  }
  return std::move(collector.result());
}

absl::StatusOr<v1::ListStrategiesResponse> OptimizerClient::ListStrategies(
    absl::Duration deadline, const std::stop_token& cancel) {
  grpc::ClientContext context;
  Authorize(context);
  SetDeadline(context, deadline);
  const std::stop_callback on_cancel(cancel, [&] { context.TryCancel(); });
  v1::ListStrategiesResponse response;
  const grpc::Status status = stub_->ListStrategies(&context, {}, &response);
  if (!status.ok()) return FromGrpc(status);
  return response;
}

}  // namespace traverse
