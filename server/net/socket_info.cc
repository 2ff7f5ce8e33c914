#include "server/net/socket_info.h"

#include <arpa/inet.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace traverse {
namespace {

// States of TCP; <netinet/tcp.h> has them, but without the count of bytes.
constexpr int kEstablished = 1;
constexpr int kCloseWait = 8;  // the peer has ended its side

}  // namespace

SocketInfo InfoOf(int socket) {
  tcp_info info{};
  socklen_t size = sizeof(info);
  if (getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
  SocketInfo result;
  result.open = info.tcpi_state == kEstablished || info.tcpi_state == kCloseWait;
  result.ended = info.tcpi_state != kEstablished;
  if (size >= offsetof(tcp_info, tcpi_bytes_received) + sizeof(info.tcpi_bytes_received)) {
    result.received = info.tcpi_bytes_received;
  }
  return result;
}

std::string PeerOf(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (getpeername(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return "";
  char text[INET6_ADDRSTRLEN] = "";
  if (address.ss_family == AF_INET) {
    const auto& v4 = *reinterpret_cast<const sockaddr_in*>(&address);
    inet_ntop(AF_INET, &v4.sin_addr, text, sizeof(text));
    return absl::StrCat(text, ":", ntohs(v4.sin_port));
  }
  if (address.ss_family != AF_INET6) return "";
  const auto& v6 = *reinterpret_cast<const sockaddr_in6*>(&address);
  if (IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr)) {
    inet_ntop(AF_INET, &v6.sin6_addr.s6_addr[12], text, sizeof(text));
  } else {
    inet_ntop(AF_INET6, &v6.sin6_addr, text, sizeof(text));
  }
  return absl::StrCat(text, ":", ntohs(v6.sin6_port));
}

std::string AddressOf(const std::string& peer) { return peer.substr(0, peer.rfind(':')); }

std::string PeerKey(const std::string& peer) {
  const size_t colon = peer.find(':');
  if (colon == std::string::npos) return peer;
  return absl::StrReplaceAll(peer.substr(colon + 1),
                             {{"%5B", ""}, {"%5D", ""}, {"[", ""}, {"]", ""}});
}

void SetUp(int socket, std::chrono::milliseconds peer_timeout) {
  const int on = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  const auto timeout = static_cast<unsigned int>(peer_timeout.count());
  setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &timeout, sizeof(timeout));
}

}  // namespace traverse
