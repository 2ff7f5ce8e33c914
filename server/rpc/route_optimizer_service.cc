#include "server/rpc/route_optimizer_service.h"

#include <grpcpp/impl/codegen/server_callback_handlers.h>

#include <utility>

#include "server/rpc/batch_reactor.h"
#include "server/rpc/call_info.h"
#include "server/rpc/grpc_status.h"
#include "server/rpc/list_strategies.h"
#include "server/rpc/stream_reactor.h"
#include "server/rpc/wire.h"
#include "server/translate/translate_result.h"

namespace traverse {

RouteOptimizerService::RouteOptimizerService(ServiceCore& core) : core_(core) {
  AddStream("/traverse.v1.RouteOptimizerService/OptimizeBatch",
            [this](grpc::CallbackServerContext* context) { return OptimizeBatch(context); });
  AddStream("/traverse.v1.RouteOptimizerService/Optimize",
            [this](grpc::CallbackServerContext* context) { return Optimize(context); });
  AddStream("/traverse.v1.RouteOptimizerService/ListStrategies",
            [this](grpc::CallbackServerContext* context) { return ListStrategies(context); });
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
  const absl::Status authorized = Authorize(*context, *core_.files.auth, call);
  return BatchReactor::Start(core_, *context, std::move(call), authorized);
}

RouteOptimizerService::Reactor* RouteOptimizerService::Optimize(
    grpc::CallbackServerContext* context) {
  CallInfo call = ReadCallInfo(*context, "Optimize");
  const absl::Status authorized = Authorize(*context, *core_.files.auth, call);
  return StreamReactor::Start(core_, *context, std::move(call), authorized);
}

RouteOptimizerService::Reactor* RouteOptimizerService::ListStrategies(
    grpc::CallbackServerContext* context) {
  CallInfo call = ReadCallInfo(*context, "ListStrategies");
  const absl::Status authorized = Authorize(*context, *core_.files.auth, call);
  return new ListStrategiesReactor(core_, call.peer, authorized);
}

}  // namespace traverse
