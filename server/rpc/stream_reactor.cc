#include "server/rpc/stream_reactor.h"

#include <utility>

#include "server/rpc/wire.h"

namespace traverse {

StreamReactor* StreamReactor::Start(ServiceCore& core, grpc::CallbackServerContext& context,
                                    CallInfo call, const absl::Status& authorized) {
  auto* reactor = new StreamReactor(core, context, std::move(call));
  if (absl::Status status = reactor->Admit(authorized, /*points=*/0); !status.ok()) {
    reactor->End(status);
  } else {
    reactor->StartRead(&reactor->read_);
  }
  return reactor;
}

void StreamReactor::ReadNext() {
  if (run()->AskForRoom()) StartRead(&read_);
}

void StreamReactor::OnReadDone(bool ok) {
  if (ok) return ReadMessage(read_);
  const std::shared_ptr<JobRun> run = this->run();
  if (!run->Hold()) return;
  if (context_.IsCancelled()) run->Abort(absl::CancelledError("the caller went away"));
  if (!run->aborted()) {
    if (const absl::Status status = OnEnd(); !status.ok()) run->Abort(status);
  }
  run->Release();  // may end the call
}

absl::Status StreamReactor::OnOptions(const RequestReader& message) {
  if (begun_ && message.has_options()) {
    return absl::InvalidArgumentError("options: set in a message that is not the first one");
  }
  if (begun_) return absl::OkStatus();
  if (absl::Status status = Begin(message.options()); !status.ok()) return status;
  begun_ = true;
  StartEngine(message.layers(), 0);
  return absl::OkStatus();
}

void StreamReactor::OnMessageRead() {
  run()->Push();
  ReadNext();
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

void StreamReactor::StartWrite(std::string message, bool more_follows) {
  grpc::WriteOptions options;
  if (more_follows) options.set_buffer_hint();
  Bidi::StartWrite(Outgoing(message), options);
}

std::string StreamReactor::Encode(const LayerOutcome& outcome, uint64_t id) const {
  return Serialize<v1::OptimizeResponse>([&](v1::OptimizeResponse& response) {
    ToProto(outcome, id, setup().strategy_name, *response.mutable_layer());
  });
}

std::string StreamReactor::Encode(const v1::JobSummary& summary) const {
  return Serialize<v1::OptimizeResponse>(
      [&](v1::OptimizeResponse& response) { *response.mutable_summary() = summary; });
}

}  // namespace traverse
