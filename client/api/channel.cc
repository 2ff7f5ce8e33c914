#include "client/api/channel.h"

#include <arpa/inet.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"

namespace traverse {
namespace {

// One attempt to connect may take this long; gRPC's default of 20 s is long for a person who waits.
constexpr int kConnectTimeoutMs = 5000;

// Finds a replaced server again as fast as a rollout replaces it; gRPC would wait for a second.
constexpr int kFirstReconnectMs = 200;

// A server that says nothing for so long, and then answers no ping for 20 s, is gone. A connection
// to a machine without power does not end by itself.
constexpr int kKeepaliveMs = 60'000;

// Leaves out servers whose health check says that they take no jobs, such as those that drain.
constexpr char kServiceConfig[] = R"({"loadBalancingConfig": [{"round_robin": {}}],
    "healthCheckConfig": {"serviceName": "traverse.v1.RouteOptimizerService"}})";

struct HostAndPort {
  std::string host;  // without brackets
  std::string port;
};

// Splits `address`; the port is empty if it has not the form HOST:PORT.
HostAndPort Split(const std::string& address) {
  const size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0) return {};
  std::string host = address.substr(0, colon);
  if (host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find_first_of(":[]/ ") != std::string::npos) {
    return {};
  }
  int port = 0;
  const std::string digits = address.substr(colon + 1);
  if (!absl::SimpleAtoi(digits, &port) || port < 1 || port > 65535) return {};
  return {std::move(host), digits};
}

// Adds the numeric addresses of `address` in gRPC's ipv6 scheme. IPv4 addresses are mapped, because
// a target has only one scheme. False if the name is unknown.
bool LookUp(const std::string& address, std::vector<std::string>& out) {
  const HostAndPort place = Split(address);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_family = AF_INET6;
  hints.ai_flags = AI_V4MAPPED | AI_ALL;
  addrinfo* found = nullptr;
  if (getaddrinfo(place.host.c_str(), place.port.c_str(), &hints, &found) != 0) return false;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
    char text[INET6_ADDRSTRLEN];
    const auto* socket = reinterpret_cast<const sockaddr_in6*>(entry->ai_addr);
    if (inet_ntop(AF_INET6, &socket->sin6_addr, text, sizeof(text)) == nullptr) continue;
    out.push_back(absl::StrFormat("[%s]:%s", text, place.port));
  }
  freeaddrinfo(found);
  return true;
}

// The bytes of a PEM file; nothing for an empty path.
absl::StatusOr<std::string> ReadPem(const char* option, const std::string& path) {
  if (path.empty()) return std::string();
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) return absl::NotFoundError(absl::StrFormat("%s: cannot read %s", option, path));
  if (bytes.find("-----BEGIN ") == std::string::npos) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s: %s contains nothing in PEM format", option, path));
  }
  return bytes;
}

// The host that all addresses share; empty if there are several.
std::string CommonHost(const std::vector<std::string>& addresses) {
  const std::string host = Split(addresses.front()).host;
  const bool all = std::all_of(addresses.begin(), addresses.end(), [&](const std::string& address) {
    return Split(address).host == host;
  });
  return all ? host : "";
}

// Sets up encryption and adds the arguments that it needs to `arguments`.
absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> MakeCredentials(
    const std::vector<std::string>& addresses, const std::optional<ChannelTls>& tls,
    grpc::ChannelArguments& arguments) {
  if (!tls) return grpc::InsecureChannelCredentials();
  if (tls->certificate.empty() != tls->key.empty()) {
    return absl::InvalidArgumentError("tls_certificate and tls_key must be given together");
  }
  grpc::SslCredentialsOptions options;
  const struct {
    const char* name;
    const std::string& path;
    std::string& bytes;
  } files[] = {{"tls_ca", tls->ca, options.pem_root_certs},
               {"tls_certificate", tls->certificate, options.pem_cert_chain},
               {"tls_key", tls->key, options.pem_private_key}};
  for (const auto& file : files) {
    absl::StatusOr<std::string> bytes = ReadPem(file.name, file.path);
    if (!bytes.ok()) return bytes.status();
    file.bytes = *std::move(bytes);
  }
  const std::string name = tls->name.empty() ? CommonHost(addresses) : tls->name;
  if (name.empty()) {
    return absl::InvalidArgumentError(
        "tls_name: with several servers, give the name that their certificates share");
  }
  // Without this gRPC compares the certificate with the numeric address, if it was given one.
  arguments.SetSslTargetNameOverride(name);
  return grpc::SslCredentials(options);
}

}  // namespace

bool IsLocal(const std::string& address) {
  const std::string host = Split(address).host;
  in_addr ipv4{};
  if (inet_pton(AF_INET, host.c_str(), &ipv4) == 1) return (ntohl(ipv4.s_addr) >> 24) == 127;
  in6_addr ipv6{};
  if (inet_pton(AF_INET6, host.c_str(), &ipv6) == 1) return IN6_IS_ADDR_LOOPBACK(&ipv6) != 0;
  return host == "localhost";
}

absl::StatusOr<std::vector<std::string>> ParseAddresses(const std::string& text) {
  const std::vector<std::string> addresses = absl::StrSplit(text, ',');
  for (const std::string& address : addresses) {
    if (Split(address).port.empty()) {
      return absl::InvalidArgumentError(absl::StrFormat("\"%s\" is not HOST:PORT", address));
    }
  }
  return addresses;
}

absl::StatusOr<std::shared_ptr<grpc::Channel>> ConnectTo(const std::vector<std::string>& addresses,
                                                         const ConnectOptions& options) {
  grpc::ChannelArguments arguments;
  auto credentials = MakeCredentials(addresses, options.tls, arguments);
  if (!credentials.ok()) return credentials.status();
  std::string target;
  if (addresses.size() == 1) {
    target = absl::StrFormat("dns:///%s", addresses.front());
  } else {
    std::vector<std::string> known;
    for (const std::string& address : addresses) LookUp(address, known);
    if (known.empty()) {
      return absl::UnavailableError(
          absl::StrFormat("found no address for %s", absl::StrJoin(addresses, ",")));
    }
    target = absl::StrFormat("ipv6:%s", absl::StrJoin(known, ","));
  }
  arguments.SetServiceConfigJSON(kServiceConfig);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, kConnectTimeoutMs);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, kFirstReconnectMs);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  // A search may take long to answer; without this the pings stop after two.
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, options.own_connection ? 1 : 0);
  arguments.SetMaxReceiveMessageSize(-1);  // an answer is as large as the layer that was sent
  return grpc::CreateCustomChannel(target, *credentials, arguments);
}

}  // namespace traverse
