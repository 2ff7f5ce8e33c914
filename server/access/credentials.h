// The transport's side of security: TLS, mutual TLS, and where plaintext is allowed.

#ifndef TRAVERSE_SERVER_ACCESS_CREDENTIALS_H_
#define TRAVERSE_SERVER_ACCESS_CREDENTIALS_H_

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "server/access/certificates.h"

namespace traverse {

// Whether `address`, as of --listen, is reached from this machine alone.
bool IsLoopback(const std::string& address);

// InvalidArgument for plaintext off loopback unless `insecure`.
absl::Status CheckPlaintext(const std::string& listen, bool insecure);

// Credentials for a port: each new connection gets what `store` has then.
std::shared_ptr<grpc::ServerCredentials> MakeTlsCredentials(
    std::shared_ptr<CertificateStore> store);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_ACCESS_CREDENTIALS_H_
