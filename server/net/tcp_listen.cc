#include "server/net/tcp_listen.h"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"

namespace traverse {
namespace {

constexpr int kBacklog = 128;

struct FreeAddresses {
  void operator()(addrinfo* infos) const { freeaddrinfo(infos); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

absl::Status CannotListen(const std::string& address, const char* why) {
  return absl::UnavailableError(absl::StrCat("cannot listen on ", address, ": ", why));
}

std::pair<std::string, std::string> SplitAddress(const std::string& address) {
  const size_t colon = address.rfind(':');
  if (colon == std::string::npos) return {address, "0"};
  std::string host = address.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  return {host, address.substr(colon + 1)};
}

void SetPort(sockaddr* address, int port) {
  if (port == 0) return;
  const auto number = htons(static_cast<uint16_t>(port));
  if (address->sa_family == AF_INET) {
    reinterpret_cast<sockaddr_in*>(address)->sin_port = number;
  } else {
    reinterpret_cast<sockaddr_in6*>(address)->sin6_port = number;
  }
}

// A listening socket, or -1 with errno set. A wildcard of IPv6 takes IPv4 too.
int Listen(const addrinfo& info) {
  const int fd = socket(info.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return -1;
  const int on = 1, off = 0;
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (info.ai_family == AF_INET6) {
    setsockopt(fd, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof(off));
  }
  if (bind(fd, info.ai_addr, info.ai_addrlen) == 0 && listen(fd, kBacklog) == 0) return fd;
  const int error = errno;
  close(fd);
  errno = error;
  return -1;
}

// The addresses of a host; those of all of the machine's: the one of IPv6 before that of IPv4.
absl::StatusOr<Addresses> Resolve(const std::string& address, bool& wildcard) {
  const auto [host, port] = SplitAddress(address);
  wildcard = host.empty() || host == "0.0.0.0" || host == "::";
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const char* const name = wildcard ? "::" : host.c_str();
  int error = getaddrinfo(name, port.c_str(), &hints, &found);
  if (error != 0) return CannotListen(address, gai_strerror(error));
  Addresses addresses(found);
  if (!wildcard) return addresses;
  error = getaddrinfo("0.0.0.0", port.c_str(), &hints, &found);
  if (error == 0) addresses->ai_next = found;
  return addresses;
}

}  // namespace

absl::StatusOr<std::vector<int>> TcpListen(const std::string& address) {
  bool wildcard = false;
  absl::StatusOr<Addresses> addresses = Resolve(address, wildcard);
  if (!addresses.ok()) return addresses.status();
  std::vector<int> sockets;
  int error = 0;
  for (addrinfo* info = addresses->get(); info != nullptr; info = info->ai_next) {
    if (wildcard && !sockets.empty()) break;
    if (!sockets.empty()) SetPort(info->ai_addr, PortOf(sockets.front()));
    const int socket = Listen(*info);
    if (socket >= 0) {
      sockets.push_back(socket);
    } else if (error == 0) {
      error = errno;
    }
    if (socket < 0 && error == EADDRINUSE) break;  // half of a host is none
  }
  if (sockets.empty() || error == EADDRINUSE) {
    for (const int socket : sockets) close(socket);
    return CannotListen(address, std::strerror(error));
  }
  return sockets;
}

int PortOf(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  if (address.ss_family == AF_INET) {
    return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
  }
  return ntohs(reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port);
}

}  // namespace traverse
