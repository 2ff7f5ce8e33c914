// TLS for HTTP connections, with the contents of the store of certificates.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_TLS_CONTEXT_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_TLS_CONTEXT_H_

#include <openssl/ssl.h>

#include <boost/asio/ssl/context.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "server/access/certificates.h"

namespace traverse::gateway {

// Not thread-safe.
class TlsContext {
 public:
  using Context = boost::asio::ssl::context;

  // Unavailable if OpenSSL does not accept the contents of `store`.
  static absl::StatusOr<std::unique_ptr<TlsContext>> Make(std::shared_ptr<CertificateStore> store);

  // For the next connection: the store's current contents, if OpenSSL accepts them.
  std::shared_ptr<Context> Current();

 private:
  explicit TlsContext(std::shared_ptr<CertificateStore> store) : store_(std::move(store)) {}

  const std::shared_ptr<CertificateStore> store_;
  std::shared_ptr<const CertificateSet> set_;  // from which context_ was made
  std::shared_ptr<Context> context_;
};

// The names in the verified certificate of a peer, as gRPC reports them: the alternative names, or
// without any the common name. Empty without a certificate.
std::vector<std::string> PeerIdentities(SSL* ssl);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_TLS_CONTEXT_H_
