// Channels to servers.

#ifndef TRAVERSE_CLIENT_API_CHANNEL_H_
#define TRAVERSE_CLIENT_API_CHANNEL_H_

#include <grpcpp/channel.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace traverse {

// Parses addresses "HOST:PORT[,HOST:PORT...]". A host is a name, an IPv4 address, or an IPv6
// address in brackets. InvalidArgument for anything else.
absl::StatusOr<std::vector<std::string>> ParseAddresses(const std::string& text);

// How a channel is secured, and how the client identifies itself.
struct ChannelTls {
  // Files in PEM, read when the channel is made.
  std::string ca;  // authorities that may sign the server's certificate; empty: the system's
  std::string certificate;  // of this client, chain with the leaf first; with `key`, for mutual TLS
  std::string key;

  // The name in the servers' certificates. Empty: the host of the one address. Required for several
  // addresses, unless their hosts are the same.
  std::string name;
};

struct ConnectOptions {
  std::optional<ChannelTls> tls = std::nullopt;  // unset: without encryption

  // True: a connection that no other channel of this process uses.
  bool own_connection = false;
};

// A channel that spreads its calls over `addresses` and everything their names resolve to, except
// servers that cannot be reached or report that they take no jobs (gRPC's round_robin with health
// checking). With several addresses, names are resolved here, once: Unavailable if none can be.
// Connects when first used. InvalidArgument, with the option's name, for TLS options that
// contradict each other; NotFound for a file that cannot be read.
absl::StatusOr<std::shared_ptr<grpc::Channel>> ConnectTo(const std::vector<std::string>& addresses,
                                                         const ConnectOptions& options = {});

// Whether an address is on this machine: localhost, 127.0.0.0/8, ::1.
bool IsLocal(const std::string& address);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_CHANNEL_H_
