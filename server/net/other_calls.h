// Counts the calls of services that gRPC brings along, health and reflection, like the service's
// own: their floods are floods too.

#ifndef TRAVERSE_SERVER_NET_OTHER_CALLS_H_
#define TRAVERSE_SERVER_NET_OTHER_CALLS_H_

#include <grpcpp/support/server_interceptor.h>

#include "server/service_core.h"

namespace traverse {

// Reports the begin and end of each call to `core`, which must outlive the server. Thread-safe.
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
