// traverse.v1.RouteOptimizerService: one method per call, each of which only starts its reactor.

#ifndef TRAVERSE_SERVER_RPC_ROUTE_OPTIMIZER_SERVICE_H_
#define TRAVERSE_SERVER_RPC_ROUTE_OPTIMIZER_SERVICE_H_

#include <grpcpp/impl/rpc_method.h>
#include <grpcpp/impl/rpc_service_method.h>
#include <grpcpp/impl/service_type.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <functional>

#include "server/service_core.h"

namespace traverse {

// Not derived from the generated class. That calls OptimizeBatch when the whole request has
// arrived, perhaps tens of MB. This class is called when the headers have arrived, so that jobs are
// refused before their bytes are read: for gRPC's server a request is a stream of one message. And
// messages are raw, see server/wire.h. Thread-safe.
class RouteOptimizerService : public grpc::Service {
 public:
  // `core` must outlive the service.
  explicit RouteOptimizerService(ServiceCore& core);

 private:
  using Reactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;
  using MakeReactor = std::function<Reactor*(grpc::CallbackServerContext*)>;

  // `name` is a literal. Takes ownership of the handler.
  void Add(const char* name, grpc::internal::RpcMethod::RpcType type,
           grpc::internal::MethodHandler* handler);
  void AddStream(const char* name, const MakeReactor& make_reactor);

  Reactor* OptimizeBatch(grpc::CallbackServerContext* context);
  Reactor* Optimize(grpc::CallbackServerContext* context);
  Reactor* ListStrategies(grpc::CallbackServerContext* context);

  ServiceCore& core_;
  int methods_ = 0;  // added so far
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_ROUTE_OPTIMIZER_SERVICE_H_
