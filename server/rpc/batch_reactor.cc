#include "server/rpc/batch_reactor.h"

#include <utility>

namespace traverse {

BatchReactor* BatchReactor::Start(ServiceCore& core, grpc::CallbackServerContext& context,
                                  CallInfo call, const absl::Status& authorized) {
  const int64_t points = EstimatePoints(call.message_bytes);
  auto* reactor = new BatchReactor(core, context, std::move(call));
  reactor->Open(authorized, points);
  return reactor;
}

absl::Status BatchReactor::OnRead(bool ok) {
  if (!ok && is_cancelled()) return absl::CancelledError("the caller went away");
  if (!ok) return absl::InvalidArgumentError("the call ended without a message");
  if (absl::Status status = Resize(EstimatePoints(incoming().Length())); !status.ok())
    return status;
  ReadMessage(incoming());
  return absl::OkStatus();
}

void BatchReactor::OnMessageRead() {
  StartEngine(layers_received(), points_received());
  run()->Close();
}

}  // namespace traverse
