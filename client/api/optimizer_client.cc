#include "client/api/optimizer_client.h"

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <string>
#include <thread>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "absl/time/clock.h"

namespace traverse {
namespace {

using Stream = grpc::ClientReaderWriter<v1::OptimizeRequest, v1::OptimizeResponse>;

// Layers are sent together up to this size: small ones cost less so, and the first answers still
// come early.
constexpr size_t kMessageBytes = size_t{32} << 10;

absl::Status FromGrpc(const grpc::Status& status) {
  if (status.ok()) return absl::OkStatus();
  return absl::Status(static_cast<absl::StatusCode>(status.error_code()), status.error_message());
}

void SetDeadline(grpc::ClientContext& context, absl::Duration deadline) {
  if (deadline == absl::InfiniteDuration()) return;
  context.set_deadline(absl::ToChronoTime(absl::Now() + deadline));
}

// Leaves an open path its ends.
void Strip(v1::OpenPath& path) {
  const int n = path.points_size();
  if (n <= 4 || n % 2 != 0) return;  // an odd number is the service's to refuse
  auto& points = *path.mutable_points();
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

// Sends the whole job, then closes this half of the stream. A write fails when the call is over;
// Finish says why.
void Send(const v1::JobOptions& options, absl::Span<const v1::Layer> layers, Stream& stream) {
  v1::OptimizeRequest request;
  *request.mutable_options() = options;
  size_t bytes = 0;
  for (const v1::Layer& layer : layers) {
    v1::Layer& sent = *request.add_layers();
    sent = Stripped(layer);
    bytes += sent.ByteSizeLong();
    if (bytes < kMessageBytes) continue;
    if (!stream.Write(request)) return;
    request.Clear();
    bytes = 0;
  }
  if (request.has_options() || request.layers_size() > 0) {
    if (!stream.Write(request)) return;
  }
  stream.WritesDone();
}

// Collects the answers of one job.
class Collector {
 public:
  Collector(absl::Span<const v1::Layer> layers, const CallOptions& call)
      : layers_(layers), call_(call) {
    result_.layers.resize(layers.size());
    answered_.resize(layers.size());
  }

  absl::Status Take(v1::OptimizeResponse response) {
    if (response.has_summary()) {
      result_.summary = std::move(*response.mutable_summary());
      finished_ = true;
      return absl::OkStatus();
    }
    const uint64_t index = response.layer().index();
    if (!response.has_layer() || index >= layers_.size() || answered_[index]) {
      return absl::InternalError("the server answered what was not asked");
    }
    v1::LayerResult& layer = result_.layers[index];
    layer = std::move(*response.mutable_layer());
    if (const absl::Status status = CheckVisits(layers_[index], layer); !status.ok()) {
      return absl::InternalError(
          absl::StrFormat("the server's answer to layers[%d] is no route: %s", index,
                          std::string(status.message())));
    }
    answered_[index] = true;
    ++answers_;
    if (call_.on_layer) call_.on_layer(layer);
    return absl::OkStatus();
  }

  absl::StatusOr<JobResult> Done() && {
    if (!finished_ || answers_ != layers_.size()) {
      return absl::InternalError(
          absl::StrFormat("the server answered %d of %d layers", answers_, layers_.size()));
    }
    return std::move(result_);
  }

 private:
  const absl::Span<const v1::Layer> layers_;
  const CallOptions& call_;
  JobResult result_;
  std::vector<bool> answered_;
  size_t answers_ = 0;
  bool finished_ = false;
};

}  // namespace

OptimizerClient::OptimizerClient(std::shared_ptr<grpc::Channel> channel)
    : stub_(v1::RouteOptimizerService::NewStub(std::move(channel))) {}

absl::StatusOr<JobResult> OptimizerClient::Optimize(const v1::JobOptions& options,
                                                    absl::Span<const v1::Layer> layers,
                                                    const CallOptions& call) {
  grpc::ClientContext context;
  SetDeadline(context, call.deadline);
  const std::unique_ptr<Stream> stream = stub_->Optimize(&context);
  std::thread sender([&] { Send(options, layers, *stream); });

  Collector collector(layers, call);
  absl::Status taken;
  v1::OptimizeResponse response;
  while (stream->Read(&response)) {
    taken = collector.Take(std::move(response));
    if (!taken.ok()) {
      context.TryCancel();
      break;
    }
    response.Clear();
  }
  // When the server has ended the call, a write that waits for room returns.
  sender.join();
  const grpc::Status status = stream->Finish();
  if (!taken.ok()) return taken;
  if (!status.ok()) return FromGrpc(status);
  return std::move(collector).Done();
}

absl::StatusOr<v1::ListStrategiesResponse> OptimizerClient::ListStrategies(
    absl::Duration deadline) {
  grpc::ClientContext context;
  SetDeadline(context, deadline);
  v1::ListStrategiesResponse response;
  const grpc::Status status = stub_->ListStrategies(&context, {}, &response);
  if (!status.ok()) return FromGrpc(status);
  return response;
}

}  // namespace traverse
