// The flags of traverse-gateway.

#ifndef TRAVERSE_CLIENT_GATEWAY_GATEWAY_FLAGS_H_
#define TRAVERSE_CLIENT_GATEWAY_GATEWAY_FLAGS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/gateway/gateway.h"

namespace traverse::gateway {

// Reads the command line, without the program's name, and the file of --config. Returns the text to
// print instead of serving, for --help and --version; otherwise an empty text. InvalidArgument, in
// one line.
absl::StatusOr<std::string> ReadFlags(const std::vector<std::string>& arguments);

// The options that the flags state, after ReadFlags. InvalidArgument if they contradict each other.
absl::StatusOr<GatewayOptions> OptionsFromFlags();

absl::Duration DrainTimeout();

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GATEWAY_FLAGS_H_
