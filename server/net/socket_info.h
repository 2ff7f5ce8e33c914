// What the kernel knows about a TCP connection.

#ifndef TRAVERSE_SERVER_NET_SOCKET_INFO_H_
#define TRAVERSE_SERVER_NET_SOCKET_INFO_H_

#include <chrono>
#include <cstdint>
#include <string>

namespace traverse {

struct SocketInfo {
  bool open = false;      // both sides may still send, or only ours
  bool ended = false;     // the peer will send no more
  uint64_t received = 0;  // bytes so far
};
SocketInfo InfoOf(int socket);

// The other side as ADDRESS:PORT, with IPv4 addresses in IPv4 form; empty if it is gone.
std::string PeerOf(int socket);

// The same for an address as gRPC writes it: ipv4:10.0.0.7:1 or ipv6:%5B::1%5D:1.
std::string PeerKey(const std::string& peer);

// The address of ADDRESS:PORT.
std::string AddressOf(const std::string& peer);

// Sends small messages at once, and gives up the connection when the other side is silent.
void SetUp(int socket, std::chrono::milliseconds peer_timeout);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_SOCKET_INFO_H_
