// HTTP/1.1, with and without TLS.
//
// Boost.Beast reads and writes. One thread serves all connections and never waits for a handler.
// The cost of a connection is bounded: its head in bytes and seconds, its body by a least rate,
// connections by their number. Bodies pass through in pieces, both ways.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_HTTP_SERVER_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_HTTP_SERVER_H_

#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/gateway/http/message.h"
#include "server/access/certificates.h"

namespace traverse::gateway {

struct HttpLimits {
  int max_connections = 512;
  int max_connections_per_address = 384;
  double files_part = 1;  // of the files that may be open, see FilesFor; fewer leave fewer of both
  uint32_t max_head_bytes = 16384;
  absl::Duration head_time = absl::Seconds(20);  // for a head, including the wait for it
  absl::Duration idle_time = absl::Seconds(30);  // without a byte of the body, either way

  // A body may take `idle_time`, and in addition a second per this many bytes, either way.
  int64_t min_bytes_per_second = 4096;

  // The most for a whole body, either way.
  absl::Duration body_time = absl::Minutes(30);

  // How long the next piece may take, for a body that began `elapsed` ago and has had `bytes`.
  absl::Duration TimeForPiece(absl::Duration elapsed, uint64_t bytes) const;
};

struct HttpServerOptions {
  std::string listen;  // HOST:PORT, [HOST]:PORT; port 0 takes a free port
  std::shared_ptr<CertificateStore> certificates = nullptr;  // null: plaintext
  HttpLimits limits;
};

class HttpServer {
 public:
  // Errors, in one line: InvalidArgument for an invalid address, Unavailable for a port or
  // certificates that cannot be used. The server's thread calls `handler`.
  static absl::StatusOr<std::unique_ptr<HttpServer>> Start(const HttpServerOptions& options,
                                                           HttpHandler handler);

  // Closes all connections.
  virtual ~HttpServer() = default;

  virtual int port() const = 0;

  // Accepts no more connections and closes idle ones; others end with their request. Returns when
  // none is left, or after `timeout`.
  virtual void Drain(absl::Duration timeout) = 0;

  // Number of open connections.
  virtual int connections() const = 0;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_HTTP_SERVER_H_
