// Counts the calls of a server on their connections, see Connections::OnCall.

#ifndef TRAVERSE_SERVER_NET_CALL_COUNTER_H_
#define TRAVERSE_SERVER_NET_CALL_COUNTER_H_

#include <grpcpp/support/server_interceptor.h>

#include <string>
#include <utility>

#include "server/net/connections.h"

namespace traverse {

// Reports the begin and end of each call to `connections`, which must outlive the server.
// Thread-safe.
class CallCounter : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  // Leaves out methods that begin with `reported` (/package.Service/), if that is not empty: their
  // service reports them itself, which costs less.
  CallCounter(Connections& connections, std::string reported)
      : connections_(connections), reported_(std::move(reported)) {}

  // Null for calls that are left out.
  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* info) override;

 private:
  Connections& connections_;
  const std::string reported_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_CALL_COUNTER_H_
