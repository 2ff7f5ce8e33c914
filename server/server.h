// The server: builds, starts, drains. Also the way to embed the service in another process:
//
//   ASSIGN_OR_RETURN(auto server, Server::Start(ServerOptions::Embedded(/*threads=*/2)));
//   auto stub = v1::RouteOptimizerService::NewStub(server->InProcessChannel({}));

#ifndef TRAVERSE_SERVER_SERVER_H_
#define TRAVERSE_SERVER_SERVER_H_

#include <grpcpp/channel.h>
#include <grpcpp/support/channel_arguments.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/access/credentials.h"
#include "server/net/listener.h"
#include "server/ops/metrics/metrics_http.h"
#include "server/rpc/route_optimizer_service.h"
#include "server/service_core.h"

namespace traverse {

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
  int port() const { return listener_->port(); }
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
  // Before core_, which reports to its connections; Shutdown ends all else in it.
  std::unique_ptr<Listener> listener_;
  ServiceCore core_;
  RouteOptimizerService service_;
  std::unique_ptr<MetricsHttp> metrics_;
  std::optional<Periodic> look_;  // at changed files; last, because it uses the other members
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_SERVER_H_
