// ListStrategies: what the server can do.

#ifndef TRAVERSE_SERVER_RPC_LIST_STRATEGIES_H_
#define TRAVERSE_SERVER_RPC_LIST_STRATEGIES_H_

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <string>

#include "absl/status/status.h"
#include "server/service_core.h"

namespace traverse {

// A bidirectional reactor, so that nothing is read from a caller who may not call. Deletes itself
// when the call is done.
class ListStrategiesReactor : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  // `peer` is the caller's address, as gRPC writes it.
  ListStrategiesReactor(ServiceCore& core, const std::string& peer, const absl::Status& authorized);
  ~ListStrategiesReactor() override;

 private:
  void OnReadDone(bool ok) override;
  void OnDone() override { delete this; }

  absl::Status Check(bool ok) const;
  void End(const absl::Status& status);

  ServiceCore& core_;
  const std::string peer_;
  grpc::ByteBuffer request_;
  grpc::ByteBuffer response_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_LIST_STRATEGIES_H_
