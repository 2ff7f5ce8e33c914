#include "server/net/other_calls.h"

#include <grpcpp/server_context.h>

#include <string>
#include <utility>

#include "absl/strings/match.h"

namespace traverse {
namespace {

constexpr char kOwnMethods[] = "/traverse.v1.";

class CountedCall : public grpc::experimental::Interceptor {
 public:
  CountedCall(ServiceCore& core, std::string peer) : core_(core), peer_(std::move(peer)) {
    core_.OnCall(peer_);
  }
  ~CountedCall() override { core_.OnCallDone(peer_); }

  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    methods->Proceed();
  }

 private:
  ServiceCore& core_;
  const std::string peer_;
};

}  // namespace

grpc::experimental::Interceptor* OtherCalls::CreateServerInterceptor(
    grpc::experimental::ServerRpcInfo* info) {
  if (absl::StartsWith(info->method(), kOwnMethods)) return nullptr;
  return new CountedCall(core_, info->server_context()->peer());
}

}  // namespace traverse
