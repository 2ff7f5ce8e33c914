// ListStrategies: what the server can do.

#ifndef TRAVERSE_SERVER_RPC_LIST_STRATEGIES_H_
#define TRAVERSE_SERVER_RPC_LIST_STRATEGIES_H_

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include "absl/status/status.h"
#include "server/service_core.h"

namespace traverse {

// A reactor of both directions, so that nothing is read of a caller who may not call. Deletes
// itself when the call is done.
class ListStrategiesReactor : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  ListStrategiesReactor(ServiceCore& core, const absl::Status& authorized);

 private:
  void OnReadDone(bool ok) override;
  void OnDone() override { delete this; }

  absl::Status Check(bool ok) const;
  void End(const absl::Status& status);

  ServiceCore& core_;
  grpc::ByteBuffer request_;
  grpc::ByteBuffer response_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_LIST_STRATEGIES_H_
