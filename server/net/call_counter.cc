#include "server/net/call_counter.h"

#include <grpcpp/server_context.h>

#include "absl/strings/match.h"

namespace traverse {
namespace {

class CountedCall : public grpc::experimental::Interceptor {
 public:
  CountedCall(Connections& connections, std::string peer)
      : connections_(connections), peer_(std::move(peer)) {
    connections_.OnCall(peer_);
  }
  ~CountedCall() override { connections_.OnCallDone(peer_); }

  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    methods->Proceed();
  }

 private:
  Connections& connections_;
  const std::string peer_;
};

}  // namespace

grpc::experimental::Interceptor* CallCounter::CreateServerInterceptor(
    grpc::experimental::ServerRpcInfo* info) {
  if (!reported_.empty() && absl::StartsWith(info->method(), reported_)) return nullptr;
  return new CountedCall(connections_, info->server_context()->peer());
}

}  // namespace traverse
