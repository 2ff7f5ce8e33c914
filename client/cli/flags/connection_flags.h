// The flags that say how servers are reached: TLS, tokens.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_CONNECTION_FLAGS_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_CONNECTION_FLAGS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/api/channel.h"
#include "client/cli/flags/flags.h"
#include "client/cli/outcome.h"

namespace traverse::cli {

// What the flags say.
struct Connection {
  ConnectOptions options;
  std::string token;  // bearer token; empty: none
};

// --tls, --tls_ca, --tls_certificate, --tls_key, --tls_name, --token_file, --insecure.
std::vector<Flag> ConnectionFlagTable();

// The token is the first line of --token_file, or without that flag TRAVERSE_TOKEN of the
// environment; never a flag, for other users of the machine can read those. InvalidArgument if it
// would go to another machine unencrypted and --insecure does not say so; for a file that cannot be
// read; for TLS flags without --tls or with no meaning together.
absl::StatusOr<Connection> ParseConnectionFlags(const Flags& flags,
                                                const std::vector<std::string>& addresses);

// InvalidArgument if one of these flags is given, for a command that asks no server.
absl::Status CheckNoConnectionFlags(const Flags& flags);

// How a command ends whose ConnectTo failed.
Outcome ConnectFault(const absl::Status& status);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_CONNECTION_FLAGS_H_
