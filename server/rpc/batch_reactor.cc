#include "server/rpc/batch_reactor.h"

#include <utility>

#include "server/rpc/wire.h"

namespace traverse {

BatchReactor* BatchReactor::Start(ServiceCore& core, grpc::CallbackServerContext& context,
                                  CallInfo call, const absl::Status& authorized) {
  const int64_t points = EstimatePoints(call.message_bytes);
  auto* reactor = new BatchReactor(core, context, std::move(call));
  if (absl::Status status = reactor->Admit(authorized, points); !status.ok()) {
    reactor->End(status);
  } else {
    reactor->StartRead(&reactor->request_);
  }
  return reactor;
}

void BatchReactor::OnReadDone(bool ok) {
  const std::shared_ptr<JobRun> run = this->run();
  if (!run->Hold()) return;
  if (const absl::Status status = OnRequest(ok); !status.ok()) run->Abort(status);
  run->Release();  // may end the call
}

absl::Status BatchReactor::OnRequest(bool ok) {
  if (!ok && context_.IsCancelled()) return absl::CancelledError("the caller went away");
  if (!ok) return absl::InvalidArgumentError("the call ended without a message");
  if (absl::Status status = Resize(EstimatePoints(request_.Length())); !status.ok()) return status;
  ReadMessage(request_);
  return absl::OkStatus();
}

void BatchReactor::OnMessageRead() {
  StartEngine(layers_received(), points_received());
  run()->Close();
}

void BatchReactor::StartWrite(std::string message, bool more_follows) {
  grpc::WriteOptions options;
  if (more_follows) options.set_buffer_hint();
  Bidi::StartWrite(Outgoing(message), options);
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
