#include "tests/server/support/server_process.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdlib>

namespace traverse::testing {
namespace {

std::vector<std::string> CommandLine(const std::vector<std::string>& flags) {
  std::vector<std::string> line = {TRAVERSE_SERVER_BINARY, "--listen=127.0.0.1:0",
                                   "--metrics_listen=127.0.0.1:0"};
  line.insert(line.end(), flags.begin(), flags.end());
  return line;
}

// The number at the end of "listening on port 41234".
int LastNumber(const std::string& line) {
  const size_t space = line.rfind(' ');
  return space == std::string::npos ? 0 : std::atoi(line.c_str() + space + 1);
}

}  // namespace

std::string HttpGet(int port, const std::string& path, int* status) {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  // A server that accepts and says nothing is a failure, not a hang.
  const timeval patience{ChildProcess::kPatience.count(), 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  std::string reply;
  if (connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0) {
    const std::string request = "GET " + path + " HTTP/1.0\r\n\r\n";
    if (write(fd, request.data(), request.size()) > 0) {
      char buffer[4096];
      for (ssize_t n = 0; (n = read(fd, buffer, sizeof(buffer))) > 0;) {
        reply.append(buffer, static_cast<size_t>(n));
      }
    }
  }
  close(fd);
  if (status != nullptr) *status = reply.size() > 12 ? std::atoi(reply.c_str() + 9) : 0;
  const size_t body = reply.find("\r\n\r\n");
  return body == std::string::npos ? "" : reply.substr(body + 4);
}

ServerProcess::ServerProcess(const std::vector<std::string>& flags) : process_(CommandLine(flags)) {
  address_ = "127.0.0.1:" + std::to_string(LastNumber(process_.ReadLine()));
  metrics_port_ = LastNumber(process_.ReadLine());
}

std::string ServerProcess::Get(const std::string& path, int* status) const {
  return HttpGet(metrics_port_, path, status);
}

double ServerProcess::Metric(const std::string& name) const {
  const std::string text = "\n" + Get("/metrics");
  const size_t at = text.find("\n" + name + " ");
  return at == std::string::npos ? -1 : std::atof(text.c_str() + at + name.size() + 2);
}

}  // namespace traverse::testing
