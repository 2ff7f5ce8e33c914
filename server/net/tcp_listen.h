// Listening sockets.

#ifndef TRAVERSE_SERVER_NET_TCP_LISTEN_H_
#define TRAVERSE_SERVER_NET_TCP_LISTEN_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace traverse {

// Non-blocking sockets that listen on `address`, HOST:PORT or [HOST]:PORT: one for each address of
// the host, or one for all of the machine's if the host is empty, 0.0.0.0 or ::. Port 0 takes a
// free one, the same for all. The caller closes them. Errors: Unavailable `cannot listen on
// ADDRESS: why`.
absl::StatusOr<std::vector<int>> TcpListen(const std::string& address);

// The port of a socket; 0 if it has none.
int PortOf(int socket);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_TCP_LISTEN_H_
