// The port for operators: /metrics, /healthz (the process lives), /readyz (it takes jobs).
//
// Plain HTTP/1.1 for GET and HEAD, one request a connection: what Prometheus, kubelet and curl
// need. One thread serves a bounded number of connections; a slow one holds up no other.

#ifndef TRAVERSE_SERVER_METRICS_HTTP_H_
#define TRAVERSE_SERVER_METRICS_HTTP_H_

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "absl/status/statusor.h"

namespace traverse {

class MetricsHttp {
 public:
  struct Sources {
    std::function<std::string()> metrics;  // text of /metrics
    std::function<bool()> ready;
  };

  // Serves on `address`, HOST:PORT or [HOST]:PORT, until it is destroyed; port 0 takes a free one.
  // The sources are called from a thread of its own. Errors: Unavailable if it cannot listen.
  static absl::StatusOr<std::unique_ptr<MetricsHttp>> Start(const std::string& address,
                                                            Sources sources);
  ~MetricsHttp();

  MetricsHttp(const MetricsHttp&) = delete;
  MetricsHttp& operator=(const MetricsHttp&) = delete;

  int port() const { return port_; }

 private:
  explicit MetricsHttp(Sources sources) : sources_(std::move(sources)) {}

  void Serve();

  // The whole answer to a request's head.
  std::string Answer(const std::string& head) const;

  const Sources sources_;
  int listener_ = -1;
  int stop_ = -1;  // an eventfd
  int port_ = 0;
  std::thread thread_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_METRICS_HTTP_H_
