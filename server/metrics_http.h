// The port for operators: /metrics, /healthz (the process lives), /readyz (it takes jobs).

#ifndef TRAVERSE_SERVER_METRICS_HTTP_H_
#define TRAVERSE_SERVER_METRICS_HTTP_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/statusor.h"

struct mg_connection;
struct mg_context;

namespace traverse {

// Serves until it is destroyed. Plain HTTP and no more than a few callers at a time: a port for the
// inner network.
class MetricsHttp {
 public:
  struct Sources {
    std::function<std::string()> metrics;  // text of /metrics
    std::function<bool()> ready;
  };

  // Listens on `address`, HOST:PORT; port 0 takes a free one. Errors: Unavailable if it cannot.
  static absl::StatusOr<std::unique_ptr<MetricsHttp>> Start(const std::string& address,
                                                            Sources sources);
  ~MetricsHttp();

  MetricsHttp(const MetricsHttp&) = delete;
  MetricsHttp& operator=(const MetricsHttp&) = delete;

  int port() const;

 private:
  explicit MetricsHttp(Sources sources) : sources_(std::move(sources)) {}

  static int OnMetrics(mg_connection* connection, void* self);
  static int OnHealth(mg_connection* connection, void* self);
  static int OnReady(mg_connection* connection, void* self);

  const Sources sources_;
  mg_context* context_ = nullptr;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_METRICS_HTTP_H_
