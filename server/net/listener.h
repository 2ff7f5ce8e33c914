// A gRPC server on a port that strangers reach: what any program of ours listens with.
//
// It accepts connections itself and watches what they bring (connections.h), bounds headers,
// streams, handshakes and silence, refuses compressed messages, which may unpack to any size, keeps
// the process within its memory (memory_watch.h), and turns away addresses that make others wait
// (lag_probe.h). A service only reports its jobs and messages to connections(). To add a port to a
// program:
//
//   ASSIGN_OR_RETURN(auto listener, Listener::Open(options, certificates, hooks));
//   MyService service(listener->connections());
//   RETURN_IF_ERROR(listener->Serve(service, "package.MyService"));

#ifndef TRAVERSE_SERVER_NET_LISTENER_H_
#define TRAVERSE_SERVER_NET_LISTENER_H_

#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/access/certificates.h"
#include "server/net/connections.h"
#include "server/net/lag_probe.h"
#include "server/net/memory_watch.h"
#include "server/ops/periodic.h"

namespace traverse {

// Limits on one connection.
struct ConnectionLimits {
  int max_connections = 1024;
  double files_part = 1;  // see ConnectionRules
  int max_streams = 100;  // calls at a time
  int max_header_bytes = 16384;
  absl::Duration keepalive_time = absl::Seconds(30);     // idle time after which the peer is pinged
  absl::Duration keepalive_timeout = absl::Seconds(10);  // for the answer to the ping
  absl::Duration max_age = absl::InfiniteDuration();     // then clients are asked to reconnect

  // A client that waits may ping as often; sooner a few times ends its connection.
  absl::Duration client_ping_interval = absl::Seconds(30);
};

struct ListenerOptions {
  std::string listen;  // HOST:PORT; port 0 takes a free port; unix:PATH; empty: in-process only
  ConnectionLimits limits;
  int64_t max_message_bytes = int64_t{64} << 20;  // the service checks it; twice as much is cut off
  int64_t max_memory = INT64_MAX;                 // of the process, in bytes
  bool reflection = true;

  // The service reports its calls to connections() itself; else they are counted for it.
  bool service_reports_calls = false;
};

// Thread-safe from Serve on.
class Listener {
 public:
  struct Hooks {
    std::function<bool(const std::string& peer, Excess excess)> end_job;  // see Connections::Hooks
    MemoryWatch::Hooks memory;  // none: the program watches its memory itself
  };

  // Binds the port. `certificates`: null for plaintext. Errors: Unavailable `cannot listen on
  // ADDRESS: why`.
  static absl::StatusOr<std::unique_ptr<Listener>> Open(
      const ListenerOptions& options, std::shared_ptr<CertificateStore> certificates, Hooks hooks);

  // Shuts down at once, if nobody did.
  ~Listener();

  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // Serves `service`, whose full name is `name`; it must outlive Shutdown. Errors: as of Open.
  absl::Status Serve(grpc::Service& service, const std::string& name);

  // What the service reports to; null unless it listens on TCP. Lives as long as this object.
  Connections* connections() { return connections_.get(); }

  grpc::Server& server() { return *server_; }
  int port() const { return port_; }  // 0 if there is none

  // Health of all services turns NOT_SERVING.
  void StopServing();

  // Takes no more connections; after `grace`, cancels the remaining calls, and waits for their end.
  void Shutdown(absl::Duration grace);

 private:
  Listener(const ListenerOptions& options, std::shared_ptr<CertificateStore> certificates,
           Hooks hooks);

  absl::Status OpenPort();
  void AddPort(grpc::ServerBuilder& builder);
  void CountCalls(const std::string& name, grpc::ServerBuilder& builder);

  // Turns away callers who make others wait.
  void WatchLag();

  const ListenerOptions options_;
  const std::shared_ptr<CertificateStore> certificates_;
  const Hooks hooks_;

  // Hands connections to acceptors_, if the port is a TCP port.
  std::unique_ptr<Connections> connections_;

  // Several, because each is locked while it takes a connection.
  std::vector<std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor>> acceptors_;

  // Of any other port: gRPC asks them for certificates at each handshake, but does not keep them.
  std::shared_ptr<grpc::ServerCredentials> credentials_;

  std::unique_ptr<grpc::Server> server_;
  int port_ = 0;
  std::optional<LagProbe> lag_probe_;
  std::optional<Periodic> watch_lag_;  // by lag_probe_
  std::optional<MemoryWatch> memory_watch_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_LISTENER_H_
