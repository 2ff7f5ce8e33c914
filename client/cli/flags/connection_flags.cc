#include "client/cli/flags/connection_flags.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/str_format.h"

namespace traverse::cli {
namespace {

// A header holds only printable ASCII.
bool IsToken(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), absl::ascii_isgraph);
}

absl::StatusOr<std::string> ReadToken(const Flags& flags) {
  if (!flags.Has("token_file")) {
    const char* variable = std::getenv("TRAVERSE_TOKEN");
    const std::string token = variable == nullptr ? "" : variable;
    if (token.empty() || IsToken(token)) return token;
    return absl::InvalidArgumentError("TRAVERSE_TOKEN: not a token: it has unprintable characters");
  }
  const std::string path = flags.Text("token_file");
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("--token_file=%s: cannot be read, or is empty", path));
  }
  absl::StripAsciiWhitespace(&line);
  if (!IsToken(line))
    return absl::InvalidArgumentError(absl::StrFormat("--token_file=%s: contains no token", path));
  return line;
}

}  // namespace

std::vector<Flag> ConnectionFlagTable() {
  return {
      {"tls", "", "encrypt; every other TLS flag implies it"},
      {"tls_ca", "FILE", "authorities of the servers (default: system's)"},
      {"tls_certificate", "FILE", "this client's certificate, for mutual TLS"},
      {"tls_key", "FILE", "private key of --tls_certificate"},
      {"tls_name", "NAME", "name in their certificates (default: the host)"},
      {"token_file", "FILE", "bearer token (default: $TRAVERSE_TOKEN)"},
      {"insecure", "", "send the token unencrypted to other machines"},
  };
}

absl::StatusOr<Connection> ParseConnectionFlags(const Flags& flags,
                                                const std::vector<std::string>& addresses) {
  Connection connection;
  const ChannelTls tls = {flags.Text("tls_ca"), flags.Text("tls_certificate"),
                          flags.Text("tls_key"), flags.Text("tls_name")};
  const bool any = flags.Has("tls_ca") || flags.Has("tls_certificate") || flags.Has("tls_key") ||
                   flags.Has("tls_name");
  if (any && flags.Has("tls") && !flags.Switch("tls")) {
    return absl::InvalidArgumentError("--tls=false contradicts the other TLS flags");
  }
  if (any || flags.Switch("tls")) connection.options.tls = tls;
  absl::StatusOr<std::string> token = ReadToken(flags);
  if (!token.ok()) return token.status();
  connection.token = *std::move(token);
  const bool local = std::all_of(addresses.begin(), addresses.end(), IsLocal);
  if (!connection.token.empty() && !connection.options.tls && !local && !flags.Switch("insecure")) {
    return absl::InvalidArgumentError(
        "the token would go to another machine unencrypted; use --tls, or --insecure");
  }
  return connection;
}

absl::Status CheckNoConnectionFlags(const Flags& flags) {
  for (const Flag& flag : ConnectionFlagTable()) {
    if (flags.Has(flag.name))
      return absl::InvalidArgumentError(absl::StrFormat("--%s needs --server", flag.name));
  }
  return absl::OkStatus();
}

Outcome ConnectFault(const absl::Status& status) {
  const std::string message(status.message());
  if (absl::IsUnavailable(status)) return {kServerFault, message};
  return UsageFault("--" + message);
}

}  // namespace traverse::cli
