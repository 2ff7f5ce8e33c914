#include "server/batch_reactor.h"

#include <google/protobuf/arena.h>

#include <utility>

#include "server/wire.h"

namespace traverse {
namespace {

// Messages up to this size are read in the thread of gRPC that brought them; a reaction has to be
// quick.
constexpr size_t kReadHereBytes = 32 << 10;

// A point is two doubles, and little else is of any size.
constexpr size_t kBytesPerPoint = 16;

}  // namespace

BatchReactor* BatchReactor::Start(ServiceCore& core, grpc::CallbackServerContext& context,
                                  CallInfo call, const absl::Status& authorized,
                                  grpc::ByteBuffer& request) {
  auto* reactor = new BatchReactor(core, context, std::move(call), request);
  reactor->Run(authorized);
  return reactor;
}

void BatchReactor::Run(const absl::Status& authorized) {
  const size_t bytes = request_.Length();
  const auto points = static_cast<int64_t>(bytes / kBytesPerPoint + 1);
  if (absl::Status status = Admit(authorized, points); !status.ok()) return End(status);
  const std::shared_ptr<JobRun> run = this->run();
  run->Hold();
  const auto read = [this, run] {
    const absl::Status status = Guarded([this] { return ReadJob(); });
    if (!status.ok()) run->Abort(status);
    run->Release();  // may end the call
  };
  if (bytes <= kReadHereBytes) {
    read();
  } else {
    queue().Submit(read);
  }
}

absl::Status BatchReactor::ReadJob() {
  if (run()->aborted()) return absl::OkStatus();
  const auto admitted = static_cast<int64_t>(request_.Length() / kBytesPerPoint + 1);
  std::vector<LabelledLayer> layers;
  {
    google::protobuf::Arena arena;
    auto* request = google::protobuf::Arena::CreateMessage<v1::OptimizeBatchRequest>(&arena);
    if (absl::Status status = ParseMessage(request_, *request); !status.ok()) return status;
    request_.Clear();
    if (absl::Status status = Begin(request->options()); !status.ok()) return status;
    absl::StatusOr<std::vector<LabelledLayer>> translated = Translate(request->layers());
    if (!translated.ok()) return translated.status();
    layers = *std::move(translated);
  }
  int64_t points = 0;
  for (const LabelledLayer& layer : layers) points += layer.points;
  StartEngine(static_cast<int64_t>(layers.size()), points);
  AddLayers(std::move(layers), admitted);
  run()->Close();
  return absl::OkStatus();
}

void BatchReactor::StartWrite(std::string message, bool more_follows) {
  write_ = ToByteBuffer(message);
  grpc::WriteOptions options;
  if (more_follows) options.set_buffer_hint();
  grpc::ServerWriteReactor<grpc::ByteBuffer>::StartWrite(&write_, options);
}

std::string BatchReactor::Encode(const LayerOutcome& outcome, uint64_t id) const {
  return Serialize<v1::OptimizeBatchResponse>([&](v1::OptimizeBatchResponse& response) {
    ToProto(outcome, id, setup().strategy_name, *response.mutable_layer());
  });
}

std::string BatchReactor::Encode(const v1::JobSummary& summary) const {
  return Serialize<v1::OptimizeBatchResponse>(
      [&](v1::OptimizeBatchResponse& response) { *response.mutable_summary() = summary; });
}

}  // namespace traverse
