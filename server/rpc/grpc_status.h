// absl::Status to grpc::Status: the only such conversion.

#ifndef TRAVERSE_SERVER_RPC_GRPC_STATUS_H_
#define TRAVERSE_SERVER_RPC_GRPC_STATUS_H_

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace traverse {

// The same code and message (cut if it is very long); payloads become the error details
// (google.rpc.Status).
grpc::Status ToGrpcStatus(const absl::Status& status);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_GRPC_STATUS_H_
