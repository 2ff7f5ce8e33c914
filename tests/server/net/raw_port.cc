#include "tests/server/net/raw_port.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "absl/strings/str_cat.h"

namespace traverse::testing {
namespace {

// Reads until the other side or the server has ended it. Ends it then for whoever else has it, as
// gRPC does.
void ReadAll(int socket) {
  char block[65536];
  while (true) {
    const ssize_t count = recv(socket, block, sizeof(block), 0);
    if (count == 0 || (count < 0 && errno != EAGAIN)) break;
    if (count < 0) usleep(1000);
  }
  shutdown(socket, SHUT_RDWR);
  close(socket);
}

}  // namespace

Port::Port(const ConnectionRules& rules, Reader reader) {
  const auto take = [this, reader](int socket, int) {
    if (reader == Reader::kTaker) return ReadAll(socket);
    std::lock_guard<std::mutex> lock(mutex_);
    readers_.emplace_back([socket] { ReadAll(socket); });
  };
  const auto end_job = [this](const std::string& peer, Excess) {
    std::lock_guard<std::mutex> lock(mutex_);
    told_.push_back(peer);
    return may_end_;
  };
  connections_ =
      *Connections::Listen("127.0.0.1:0", rules, {.hand_over = take, .end_job = end_job});
  connections_->Start();
}

Port::~Port() {
  connections_.reset();
  for (std::thread& reader : readers_) reader.join();
}

std::vector<std::string> Port::told() {
  std::lock_guard<std::mutex> lock(mutex_);
  return told_;
}

Caller::Caller(int port, const char* source) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  inet_pton(AF_INET, source, &address.sin_addr);
  bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address));
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address));
  sockaddr_in own{};
  socklen_t size = sizeof(own);
  getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
  peer_ = absl::StrCat("ipv4:", source, ":") + std::to_string(ntohs(own.sin_port));
}

Caller::~Caller() { close(socket_); }

void Caller::Send(size_t bytes) const {
  const std::string block(bytes, 'x');
  for (size_t sent = 0; sent < bytes;) {
    const ssize_t count = send(socket_, block.data() + sent, bytes - sent, MSG_NOSIGNAL);
    if (count <= 0) return;
    sent += static_cast<size_t>(count);
  }
}

bool Caller::IsCut() const {
  char byte = 0;
  const ssize_t count = recv(socket_, &byte, 1, MSG_DONTWAIT);
  return count == 0 || (count < 0 && errno != EAGAIN);
}

}  // namespace traverse::testing
