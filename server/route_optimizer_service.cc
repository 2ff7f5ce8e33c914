#include "server/route_optimizer_service.h"

#include <utility>

#include "server/batch_reactor.h"
#include "server/call_info.h"
#include "server/grpc_status.h"
#include "server/stream_reactor.h"
#include "server/translate_result.h"
#include "server/wire.h"

namespace traverse {

grpc::ServerWriteReactor<grpc::ByteBuffer>* RouteOptimizerService::OptimizeBatch(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  // gRPC keeps the request until the call ends. The object is its own and not const, and emptying
  // it frees what is by far the largest part of a job.
  CallInfo call = ReadCallInfo(*context, "OptimizeBatch");
  const absl::Status authorized = Authorize(*context, *core_.auth, call);
  return BatchReactor::Start(core_, *context, std::move(call), authorized,
                             const_cast<grpc::ByteBuffer&>(*request));
}

grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* RouteOptimizerService::Optimize(
    grpc::CallbackServerContext* context) {
  CallInfo call = ReadCallInfo(*context, "Optimize");
  const absl::Status authorized = Authorize(*context, *core_.auth, call);
  return StreamReactor::Start(core_, *context, std::move(call), authorized);
}

grpc::ServerUnaryReactor* RouteOptimizerService::ListStrategies(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
    grpc::ByteBuffer* response) {
  CallInfo call = ReadCallInfo(*context, "ListStrategies");
  absl::Status status = Authorize(*context, *core_.auth, call);
  v1::ListStrategiesRequest parsed;
  if (status.ok()) status = ParseMessage(*request, parsed);
  if (status.ok()) {
    *response = ToByteBuffer(Serialize<v1::ListStrategiesResponse>(
        [](v1::ListStrategiesResponse& message) { traverse::ListStrategies(message); }));
  }
  core_.metrics.CountRpc("ListStrategies", status.code());
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(ToGrpcStatus(status));
  return reactor;
}

}  // namespace traverse
