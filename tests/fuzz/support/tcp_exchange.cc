#include "tests/fuzz/support/tcp_exchange.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>

namespace traverse::fuzz {

Exchange TcpExchange(int port, const std::string& bytes, int patience_ms) {
  Exchange exchange;
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0) {
    // What is sent fits a socket's buffer; a server that ends early makes it fail.
    if (send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0) shutdown(fd, SHUT_WR);
    pollfd events{fd, POLLIN, 0};
    while (poll(&events, 1, patience_ms) > 0) {
      char buffer[4096];
      const ssize_t n = recv(fd, buffer, sizeof(buffer), 0);
      if (n <= 0) {
        exchange.ended = true;
        break;
      }
      exchange.reply.append(buffer, static_cast<size_t>(n));
    }
  }
  // Ended at once rather than left in TIME_WAIT, of which there are only so many.
  const linger at_once{1, 0};
  setsockopt(fd, SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
  close(fd);
  return exchange;
}

}  // namespace traverse::fuzz
