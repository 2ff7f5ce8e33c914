#include "server/rpc/stream_reactor.h"

#include <utility>

namespace traverse {

StreamReactor* StreamReactor::Start(ServiceCore& core, grpc::CallbackServerContext& context,
                                    CallInfo call, const absl::Status& authorized) {
  auto* reactor = new StreamReactor(core, context, std::move(call));
  reactor->Open(authorized, /*points=*/0);
  return reactor;
}

void StreamReactor::ReadIfRoom() {
  if (run()->AskForRoom()) ReadNext();
}

absl::Status StreamReactor::OnRead(bool ok) {
  if (ok) {
    ReadMessage(incoming());
    return absl::OkStatus();
  }
  if (is_cancelled()) return absl::CancelledError("the caller went away");
  return run()->aborted() ? absl::OkStatus() : OnEnd();
}

absl::Status StreamReactor::OnOptions(const RequestReader& message) {
  if (begun_ && message.has_options()) {
    return absl::InvalidArgumentError("options: allowed only in the first message");
  }
  if (begun_) return absl::OkStatus();
  if (absl::Status status = Begin(message.options()); !status.ok()) return status;
  begun_ = true;
  StartEngine(message.layers(), 0);
  return absl::OkStatus();
}

void StreamReactor::OnMessageRead() {
  run()->Push();
  ReadIfRoom();
}

// A stream without any message is a job of no layers.
absl::Status StreamReactor::OnEnd() {
  if (!begun_) {
    begun_ = true;
    if (absl::Status status = Begin(v1::JobOptions()); !status.ok()) return status;
    StartEngine(0, 0);
    ForgetStrategy();
  }
  run()->Close();
  return absl::OkStatus();
}

}  // namespace traverse
