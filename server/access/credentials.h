// The transport's part of security: TLS, mutual TLS, and where plaintext is allowed.

#ifndef TRAVERSE_SERVER_ACCESS_CREDENTIALS_H_
#define TRAVERSE_SERVER_ACCESS_CREDENTIALS_H_

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "server/access/certificates.h"

namespace traverse {

// Whether only this machine can reach `address`, as given to --listen.
bool IsLoopback(const std::string& address);

// InvalidArgument for plaintext off loopback unless `insecure`.
absl::Status CheckPlaintext(const std::string& listen, bool insecure);

// Credentials for a port: each new connection gets the current certificates of `store`.
std::shared_ptr<grpc::ServerCredentials> MakeTlsCredentials(
    std::shared_ptr<CertificateStore> store);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_ACCESS_CREDENTIALS_H_
