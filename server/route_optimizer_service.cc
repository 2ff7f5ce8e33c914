#include "server/route_optimizer_service.h"

#include <grpcpp/impl/codegen/server_callback_handlers.h>

#include <utility>

#include "server/batch_reactor.h"
#include "server/call_info.h"
#include "server/grpc_status.h"
#include "server/stream_reactor.h"
#include "server/translate_result.h"
#include "server/wire.h"

namespace traverse {

RouteOptimizerService::RouteOptimizerService(ServiceCore& core) : core_(core) {
  AddStream("/traverse.v1.RouteOptimizerService/OptimizeBatch",
            [this](grpc::CallbackServerContext* context) { return OptimizeBatch(context); });
  AddStream("/traverse.v1.RouteOptimizerService/Optimize",
            [this](grpc::CallbackServerContext* context) { return Optimize(context); });
  Add("/traverse.v1.RouteOptimizerService/ListStrategies", grpc::internal::RpcMethod::NORMAL_RPC,
      new grpc::internal::CallbackUnaryHandler<grpc::ByteBuffer, grpc::ByteBuffer>(
          [this](grpc::CallbackServerContext* context, const grpc::ByteBuffer* request,
                 grpc::ByteBuffer* response) {
            return ListStrategies(context, request, response);
          }));
}

void RouteOptimizerService::AddStream(const char* name, const MakeReactor& make_reactor) {
  Add(name, grpc::internal::RpcMethod::BIDI_STREAMING,
      new grpc::internal::CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(make_reactor));
}

void RouteOptimizerService::Add(const char* name, grpc::internal::RpcMethod::RpcType type,
                                grpc::internal::MethodHandler* handler) {
  AddMethod(new grpc::internal::RpcServiceMethod(name, type, nullptr));
  MarkMethodRawCallback(methods_++, handler);
}

RouteOptimizerService::Reactor* RouteOptimizerService::OptimizeBatch(
    grpc::CallbackServerContext* context) {
  CallInfo call = ReadCallInfo(*context, "OptimizeBatch");
  const absl::Status authorized = Authorize(*context, *core_.auth, call);
  return BatchReactor::Start(core_, *context, std::move(call), authorized);
}

RouteOptimizerService::Reactor* RouteOptimizerService::Optimize(
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
