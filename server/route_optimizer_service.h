// traverse.v1.RouteOptimizerService: one method a call, each of which only starts its reactor.

#ifndef TRAVERSE_SERVER_ROUTE_OPTIMIZER_SERVICE_H_
#define TRAVERSE_SERVER_ROUTE_OPTIMIZER_SERVICE_H_

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include "server/service_core.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse {

using RawRouteOptimizerService = v1::RouteOptimizerService::WithRawCallbackMethod_OptimizeBatch<
    v1::RouteOptimizerService::WithRawCallbackMethod_Optimize<
        v1::RouteOptimizerService::WithRawCallbackMethod_ListStrategies<
            v1::RouteOptimizerService::Service>>>;

// Raw methods: see server/wire.h. Thread-safe.
class RouteOptimizerService : public RawRouteOptimizerService {
 public:
  // `core` outlives the service.
  explicit RouteOptimizerService(ServiceCore& core) : core_(core) {}

  grpc::ServerWriteReactor<grpc::ByteBuffer>* OptimizeBatch(
      grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) override;

  grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* Optimize(
      grpc::CallbackServerContext* context) override;

  grpc::ServerUnaryReactor* ListStrategies(grpc::CallbackServerContext* context,
                                           const grpc::ByteBuffer* request,
                                           grpc::ByteBuffer* response) override;

 private:
  using RawRouteOptimizerService::ListStrategies;
  using RawRouteOptimizerService::Optimize;
  using RawRouteOptimizerService::OptimizeBatch;

  ServiceCore& core_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_ROUTE_OPTIMIZER_SERVICE_H_
