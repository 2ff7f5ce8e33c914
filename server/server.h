// The server: builds, starts, drains. Also the way to embed the service in another process:
//
//   ASSIGN_OR_RETURN(auto server, Server::Start(ServerOptions::Embedded(/*threads=*/2)));
//   auto stub = v1::RouteOptimizerService::NewStub(server->InProcessChannel({}));

#ifndef TRAVERSE_SERVER_SERVER_H_
#define TRAVERSE_SERVER_SERVER_H_

#include <grpcpp/channel.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <grpcpp/support/channel_arguments.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/access/credentials.h"
#include "server/net/lag_probe.h"
#include "server/ops/metrics/metrics_http.h"
#include "server/rpc/route_optimizer_service.h"
#include "server/service_core.h"

namespace traverse {

// Limits on one connection.
struct ConnectionLimits {
  int max_connections = 1024;
  int max_streams = 100;  // calls at a time
  int max_header_bytes = 16384;
  absl::Duration keepalive_time = absl::Seconds(30);     // idle time after which the peer is pinged
  absl::Duration keepalive_timeout = absl::Seconds(10);  // for the answer to the ping
  absl::Duration max_age = absl::InfiniteDuration();     // then clients are asked to reconnect
};

struct ServerOptions {
  std::string listen;          // HOST:PORT; port 0 takes a free port; empty: in-process only
  std::string metrics_listen;  // the same; empty: no such port
  bool reflection = true;
  int64_t max_memory = INT64_MAX;  // of the process, in bytes; jobs get a part of it
  bool insecure = false;           // plaintext on addresses that other machines can reach
  TlsOptions tls;
  ConnectionLimits connections;
  ServiceOptions service;

  // No ports, no log, and only the limits that bound memory. `threads` 0: one per core.
  static ServerOptions Embedded(int threads);
};

// The number of cores this process may use, at least 1.
int UsableCores();

// Thread-safe.
class Server {
 public:
  // Errors, in one line: InvalidArgument for plaintext without --insecure, and for unusable
  // files of tokens or certificates; Unavailable for a port or a log file that cannot be
  // opened.
  static absl::StatusOr<std::unique_ptr<Server>> Start(const ServerOptions& options);

  // Ends all running calls at once.
  ~Server();

  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // The chosen ports; 0 if there is none.
  int port() const { return port_; }
  int metrics_port() const { return metrics_ == nullptr ? 0 : metrics_->port(); }

  // A channel to the service without any port. The server must outlive its calls.
  std::shared_ptr<grpc::Channel> InProcessChannel(const grpc::ChannelArguments& arguments);

  // Turns NOT_SERVING, refuses new jobs, and waits for the running ones for at most `timeout`.
  // Those that remain then end with UNAVAILABLE. Afterwards the ports are closed. Returns true if
  // none remained.
  bool Drain(absl::Duration timeout);

  ServiceCore& core() { return core_; }

  // Reopens the log and reads tokens and certificates again, in case somebody changed them.
  void Reload() { core_.files.Reload(/*anyway=*/true); }

 private:
  explicit Server(const ServerOptions& options);
  absl::Status Build(const ServerOptions& options);
  absl::Status AddPort(const ServerOptions& options, grpc::ServerBuilder& builder);

  // Turns away callers who make others wait.
  void WatchLag();

  // Takes no more connections; after `grace`, cancels the remaining calls.
  void Shutdown(absl::Duration grace);

  // Hands connections to acceptors_, if the port is a TCP port. Before core_, which uses it.
  std::unique_ptr<Connections> connections_;
  ServiceCore core_;
  RouteOptimizerService service_;
  std::unique_ptr<MetricsHttp> metrics_;

  // Several, because each is locked while it takes a connection.
  std::vector<std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor>> acceptors_;
  std::unique_ptr<grpc::Server> server_;
  int port_ = 0;
  std::optional<LagProbe> lag_probe_;
  std::optional<Periodic> watch_lag_;  // by lag_probe_
  std::optional<Periodic> look_;       // at changed files; last, because it uses the other members
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_SERVER_H_
