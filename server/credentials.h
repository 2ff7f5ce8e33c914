// The transport's side of security: TLS, mutual TLS, and where plaintext is allowed.

#ifndef TRAVERSE_SERVER_CREDENTIALS_H_
#define TRAVERSE_SERVER_CREDENTIALS_H_

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace traverse {

// Files in PEM. They are looked at once a second; new content counts for new connections.
struct TlsOptions {
  std::string certificate;  // chain, leaf first; empty: no TLS
  std::string key;
  std::string client_ca;  // not empty: a client certificate of these authorities is required

  bool enabled() const { return !certificate.empty() || !key.empty() || !client_ca.empty(); }
};

// Whether `address`, as of --listen, is reached from this machine alone.
bool IsLoopback(const std::string& address);

// Credentials for a port. Errors, with one line that says what is wrong: InvalidArgument for
// plaintext off loopback unless `insecure`; Unavailable for files that cannot be read or do not fit
// together.
absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> MakeServerCredentials(
    const TlsOptions& tls, const std::string& listen, bool insecure);

// When the certificate in a PEM file ends; nothing if it cannot be read.
std::optional<absl::Time> CertificateExpiry(const std::string& path);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_CREDENTIALS_H_
