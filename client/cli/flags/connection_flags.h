// The flags about connections to servers: TLS, tokens.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_CONNECTION_FLAGS_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_CONNECTION_FLAGS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/api/channel.h"
#include "client/cli/flags/flags.h"
#include "client/cli/outcome.h"

namespace traverse::cli {

// The values of these flags.
struct Connection {
  ConnectOptions options;
  std::string token;  // bearer token; empty: none
};

// --tls, --tls_ca, --tls_certificate, --tls_key, --tls_name, --token_file, --insecure.
std::vector<Flag> ConnectionFlagTable();

// The token is the first line of --token_file, or without that flag the environment variable
// TRAVERSE_TOKEN. It is never a flag, because other users of the machine can read flags.
// InvalidArgument if it would go to another machine unencrypted without --insecure; for a file that
// cannot be read; for TLS flags without --tls, or that contradict each other.
absl::StatusOr<Connection> ParseConnectionFlags(const Flags& flags,
                                                const std::vector<std::string>& addresses);

// InvalidArgument if one of these flags is given to a command that contacts no server.
absl::Status CheckNoConnectionFlags(const Flags& flags);

// How a command ends when ConnectTo failed.
Outcome ConnectFault(const absl::Status& status);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_CONNECTION_FLAGS_H_
