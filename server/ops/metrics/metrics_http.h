// The port for operators: /metrics, /healthz (the process lives), /readyz (it accepts jobs).
//
// Plain HTTP/1.1 for GET and HEAD, one request per connection, as Prometheus, kubelet and curl
// need. libmicrohttpd speaks HTTP, in one thread. If many connections are open, the oldest is
// closed: a client that asks and reads is done in milliseconds, and idle clients never keep it
// out.

#ifndef TRAVERSE_SERVER_OPS_METRICS_METRICS_HTTP_H_
#define TRAVERSE_SERVER_OPS_METRICS_METRICS_HTTP_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/statusor.h"

struct MHD_Connection;
struct MHD_Daemon;

namespace traverse {

class MetricsHttp {
 public:
  struct Sources {
    std::function<std::string()> metrics;  // text of /metrics
    std::function<bool()> ready;
    std::function<bool()> healthy = [] { return true; };
  };

  // Serves on `address`, HOST:PORT or [HOST]:PORT, until it is destroyed; port 0 takes a free port.
  // Calls the sources from a thread of its own. Errors: Unavailable if it cannot listen.
  static absl::StatusOr<std::unique_ptr<MetricsHttp>> Start(const std::string& address,
                                                            Sources sources);
  ~MetricsHttp();

  MetricsHttp(const MetricsHttp&) = delete;
  MetricsHttp& operator=(const MetricsHttp&) = delete;

  int port() const { return port_; }

 private:
  struct Answer {
    unsigned int status;
    std::string body;
  };
  struct Callbacks;  // of libmicrohttpd

  explicit MetricsHttp(Sources sources) : sources_(std::move(sources)) {}

  Answer AnswerTo(const std::string& method, const std::string& path) const;

  // Connections open and close; called only in the daemon's thread.
  void* OnOpened(int fd);
  void OnClosed(void* handle) { connections_.erase(reinterpret_cast<uintptr_t>(handle)); }

  const Sources sources_;
  int port_ = 0;
  MHD_Daemon* daemon_ = nullptr;
  uintptr_t opened_ = 0;                  // so far
  std::map<uintptr_t, int> connections_;  // sockets, by when they were opened
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_METRICS_METRICS_HTTP_H_
