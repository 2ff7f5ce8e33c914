// Channels to servers.

#ifndef TRAVERSE_CLIENT_API_CHANNEL_H_
#define TRAVERSE_CLIENT_API_CHANNEL_H_

#include <grpcpp/channel.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace traverse {

// The addresses in "HOST:PORT[,HOST:PORT...]"; a host is a name, an IPv4 address or an IPv6 address
// in brackets. InvalidArgument for anything else.
absl::StatusOr<std::vector<std::string>> ParseAddresses(const std::string& text);

struct ConnectOptions {
  // True: a connection that no other channel of this process shares.
  bool own_connection = false;
};

// A channel that spreads its calls over `addresses` and all that their names stand for, those that
// cannot be reached or say that they take no jobs left out (gRPC's round_robin, its health
// checking). Names of several addresses are looked up here, once: Unavailable if none of them is
// known. Connects when first used. Without encryption.
absl::StatusOr<std::shared_ptr<grpc::Channel>> ConnectTo(const std::vector<std::string>& addresses,
                                                         const ConnectOptions& options = {});

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_CHANNEL_H_
