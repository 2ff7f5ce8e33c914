#include "server/metrics_http.h"

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace traverse {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMaxConnections = 32;
constexpr size_t kMaxHeadBytes = 8192;
constexpr auto kConnectionTime = std::chrono::seconds(5);
constexpr int kPollMilliseconds = 1000;
constexpr int kBacklog = 16;

struct Connection {
  int fd;
  Clock::time_point end;
  std::string head;    // read so far
  std::string answer;  // left to write; empty while reading
};

// HOST:PORT, or [HOST]:PORT. Empty host: any address.
std::pair<std::string, std::string> SplitAddress(const std::string& address) {
  const size_t colon = address.rfind(':');
  if (colon == std::string::npos) return {address, "0"};
  std::string host = address.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  return {host, address.substr(colon + 1)};
}

// A listening socket, or -1 with errno set.
int Listen(const addrinfo& info) {
  const int fd = socket(info.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return -1;
  const int on = 1;
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (bind(fd, info.ai_addr, info.ai_addrlen) == 0 && listen(fd, kBacklog) == 0) return fd;
  const int error = errno;
  close(fd);
  errno = error;
  return -1;
}

int PortOf(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  if (address.ss_family == AF_INET) {
    return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
  }
  return ntohs(reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port);
}

std::string HttpAnswer(const char* status, const std::string& body, bool with_body) {
  return absl::StrCat("HTTP/1.1 ", status,
                      "\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8"
                      "\r\nContent-Length: ",
                      body.size(), "\r\nConnection: close\r\n\r\n", with_body ? body : "");
}

// Reads what is there. False if the connection is over.
bool ReadHead(Connection& connection) {
  char buffer[1024];
  const ssize_t n = read(connection.fd, buffer, sizeof(buffer));
  if (n > 0) connection.head.append(buffer, static_cast<size_t>(n));
  return n > 0 || (n < 0 && (errno == EAGAIN || errno == EINTR));
}

// Writes what fits. False if all is written or the connection is over.
bool WriteAnswer(Connection& connection) {
  const ssize_t n =
      send(connection.fd, connection.answer.data(), connection.answer.size(), MSG_NOSIGNAL);
  if (n > 0) connection.answer.erase(0, static_cast<size_t>(n));
  return !connection.answer.empty() && (n > 0 || errno == EAGAIN || errno == EINTR);
}

}  // namespace

absl::StatusOr<std::unique_ptr<MetricsHttp>> MetricsHttp::Start(const std::string& address,
                                                                Sources sources) {
  const auto [host, port] = SplitAddress(address);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* infos = nullptr;
  const int error =
      getaddrinfo(host.empty() ? nullptr : host.c_str(), port.c_str(), &hints, &infos);
  if (error != 0) {
    return absl::UnavailableError(
        absl::StrCat("cannot listen on ", address, " for metrics: ", gai_strerror(error)));
  }
  std::unique_ptr<MetricsHttp> http(new MetricsHttp(std::move(sources)));
  for (const addrinfo* info = infos; info != nullptr && http->listener_ < 0; info = info->ai_next) {
    http->listener_ = Listen(*info);
  }
  const int listen_errno = errno;
  freeaddrinfo(infos);
  if (http->listener_ < 0) {
    return absl::UnavailableError(
        absl::StrCat("cannot listen on ", address, " for metrics: ", std::strerror(listen_errno)));
  }
  http->port_ = PortOf(http->listener_);
  http->stop_ = eventfd(0, EFD_CLOEXEC);
  http->thread_ = std::thread([self = http.get()] { self->Serve(); });
  return http;
}

MetricsHttp::~MetricsHttp() {
  if (thread_.joinable()) {
    eventfd_write(stop_, 1);
    thread_.join();
  }
  if (stop_ >= 0) close(stop_);
  if (listener_ >= 0) close(listener_);
}

std::string MetricsHttp::Answer(const std::string& head) const {
  const bool get = head.rfind("GET ", 0) == 0;
  if (!get && head.rfind("HEAD ", 0) != 0) return HttpAnswer("405 Method Not Allowed", "", false);
  const size_t begin = head.find(' ') + 1;
  const std::string path = head.substr(begin, head.find_first_of(" ?\r\n", begin) - begin);
  if (path == "/metrics") return HttpAnswer("200 OK", sources_.metrics(), get);
  if (path == "/healthz") return HttpAnswer("200 OK", "ok\n", get);
  if (path == "/readyz") {
    return sources_.ready() ? HttpAnswer("200 OK", "ready\n", get)
                            : HttpAnswer("503 Service Unavailable", "draining\n", get);
  }
  return HttpAnswer("404 Not Found", "there are /metrics, /healthz and /readyz\n", get);
}

void MetricsHttp::Serve() {
  std::vector<Connection> connections;
  while (true) {
    std::vector<pollfd> polled = {{stop_, POLLIN, 0}, {listener_, POLLIN, 0}};
    if (connections.size() >= kMaxConnections) polled[1].fd = -1;
    for (const Connection& connection : connections) {
      const short events = connection.answer.empty() ? POLLIN : POLLOUT;
      polled.push_back({connection.fd, events, 0});
    }
    poll(polled.data(), polled.size(), kPollMilliseconds);
    if (polled[0].revents != 0) break;
    const Clock::time_point now = Clock::now();
    for (size_t i = connections.size(); i-- > 0;) {
      Connection& connection = connections[i];
      bool open = now < connection.end;
      if (open && polled[i + 2].revents != 0) {
        if (connection.answer.empty()) {
          open = ReadHead(connection) && connection.head.size() <= kMaxHeadBytes;
          if (open && connection.head.find("\r\n\r\n") != std::string::npos) {
            connection.answer = Answer(connection.head);
          }
        } else {
          open = WriteAnswer(connection);
        }
      }
      if (open) continue;
      close(connection.fd);
      connections.erase(connections.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (polled[1].revents == 0) continue;
    const int fd = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd >= 0) {
      connections.push_back({fd, now + kConnectionTime, "", ""});
    } else if (errno == EMFILE || errno == ENFILE) {
      // It stays readable; without a pause this loop would take a core.
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  for (const Connection& connection : connections) close(connection.fd);
}

}  // namespace traverse
