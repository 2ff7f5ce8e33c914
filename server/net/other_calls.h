// Counts the calls of services that gRPC brings along, health and reflection, as the service's own
// are counted: their floods are floods too.

#ifndef TRAVERSE_SERVER_NET_OTHER_CALLS_H_
#define TRAVERSE_SERVER_NET_OTHER_CALLS_H_

#include <grpcpp/support/server_interceptor.h>

#include "server/service_core.h"

namespace traverse {

// Tells `core`, which outlives the server, of each call's begin and end. Thread-safe.
class OtherCalls : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit OtherCalls(ServiceCore& core) : core_(core) {}

  // Null for calls of the service itself.
  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* info) override;

 private:
  ServiceCore& core_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_OTHER_CALLS_H_
