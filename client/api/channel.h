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

// The addresses in "HOST:PORT[,HOST:PORT...]"; a host is a name, an IPv4 address or an IPv6 address
// in brackets. InvalidArgument for anything else.
absl::StatusOr<std::vector<std::string>> ParseAddresses(const std::string& text);

// How a channel is secured, and who it is from.
struct ChannelTls {
  // Files in PEM, read when the channel is made.
  std::string ca;  // authorities that the server's certificate may be from; empty: the system's
  std::string certificate;  // of this client, chain with the leaf first; with `key`, for mutual TLS
  std::string key;

  // The name that the servers' certificates have to be for. Empty: the host of the one address.
  // Several addresses need it, unless their hosts are the same.
  std::string name;
};

struct ConnectOptions {
  std::optional<ChannelTls> tls = std::nullopt;  // unset: without encryption

  // True: a connection that no other channel of this process shares.
  bool own_connection = false;
};

// A channel that spreads its calls over `addresses` and all that their names stand for, those that
// cannot be reached or say that they take no jobs left out (gRPC's round_robin, its health
// checking). Names of several addresses are looked up here, once: Unavailable if none of them is
// known. Connects when first used. InvalidArgument, with the option's name, for TLS options that do
// not fit together; NotFound for a file that cannot be read.
absl::StatusOr<std::shared_ptr<grpc::Channel>> ConnectTo(const std::vector<std::string>& addresses,
                                                         const ConnectOptions& options = {});

// Whether an address is of this machine: localhost, 127.0.0.0/8, ::1.
bool IsLocal(const std::string& address);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_CHANNEL_H_
