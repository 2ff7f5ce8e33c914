// The gateway: builds, starts, drains.

#ifndef TRAVERSE_CLIENT_GATEWAY_GATEWAY_H_
#define TRAVERSE_CLIENT_GATEWAY_GATEWAY_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/api/channel.h"
#include "client/api/embedded.h"
#include "client/gateway/api/router.h"
#include "client/gateway/core.h"
#include "client/gateway/grpc/gcode_grpc_service.h"
#include "client/gateway/http/http_server.h"
#include "client/gateway/octoprint/printer_api.h"
#include "server/access/credentials.h"
#include "server/net/listener.h"
#include "server/net/memory_watch.h"
#include "server/ops/metrics/metrics_http.h"
#include "server/ops/periodic.h"

namespace traverse::gateway {

struct GatewayOptions {
  std::string listen_http;     // HOST:PORT; port 0 takes a free port
  std::string listen;          // the same, for gRPC; empty: no gRPC
  std::string metrics_listen;  // the same; empty: only those on listen_http
  bool insecure = false;       // plaintext on addresses that other machines can reach
  TlsOptions tls;
  HttpLimits http;
  ConnectionLimits connections;    // of gRPC
  int64_t max_memory = INT64_MAX;  // of the process, in bytes; files get a part of it
  CoreOptions core;

  // The service: these servers, or an embedded one with `threads` threads.
  std::vector<std::string> servers;
  ConnectOptions connect;
  std::string token;  // goes with calls to the servers
  int threads = 1;

  std::string printers_file;  // empty: no printers
  absl::Duration upload_deadline = absl::Seconds(60);
  UpstreamLimits upstream;

  // Of what the limit of open files leaves room for less than flags say, in words; empty: of
  // nothing.
  std::string few_files;
};

// Thread-safe.
class Gateway {
 public:
  // Errors, in one line: InvalidArgument for options that contradict each other and for unusable
  // files; Unavailable for a port or a file that cannot be opened.
  static absl::StatusOr<std::unique_ptr<Gateway>> Start(const GatewayOptions& options);

  // Ends all running requests at once.
  ~Gateway();

  // The chosen ports; 0 if there is none.
  int http_port() const { return http_->port(); }
  int grpc_port() const { return listener_ == nullptr ? 0 : listener_->port(); }
  int metrics_port() const { return metrics_ == nullptr ? 0 : metrics_->port(); }

  // Accepts no more files, and waits for at most `timeout` until the running ones have ended and
  // callers have fetched the results of their jobs. Returns true if none remained.
  bool Drain(absl::Duration timeout);

  // Reopens the log and reads tokens and certificates again, in case somebody changed them.
  void Reload() { core_->files.Reload(/*anyway=*/true); }

  Core& core() { return *core_; }

 private:
  Gateway() = default;

  absl::Status OpenService(const GatewayOptions& options);
  absl::Status OpenPrinters(const GatewayOptions& options);
  absl::Status StartGrpc(const GatewayOptions& options);
  MemoryWatch::Hooks MemoryHooks();
  absl::Status StartHttp(const GatewayOptions& options);

  // In the order of their creation; each uses those before it.
  std::unique_ptr<EmbeddedService> embedded_;
  std::unique_ptr<Core> core_;
  std::unique_ptr<PrinterApi> printers_;
  std::unique_ptr<Router> router_;
  std::unique_ptr<GcodeGrpcService> grpc_service_;
  std::unique_ptr<Listener> listener_;       // of gRPC
  std::optional<MemoryWatch> memory_watch_;  // where there is none
  std::unique_ptr<HttpServer> http_;
  std::unique_ptr<MetricsHttp> metrics_;
  std::optional<Periodic> look_;  // at changed files
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_GATEWAY_H_
