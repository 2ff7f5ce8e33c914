// The server's certificate with its key, and the authorities of its clients: read from files when
// they change, and used only if they are good.

#ifndef TRAVERSE_SERVER_ACCESS_CERTIFICATES_H_
#define TRAVERSE_SERVER_ACCESS_CERTIFICATES_H_

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "engine/base/mutex.h"
#include "server/access/text_file.h"

namespace traverse {

// Files in PEM.
struct TlsOptions {
  std::string certificate;  // chain, leaf first; empty: no TLS
  std::string key;
  std::string client_ca;  // if not empty, a client certificate of these authorities is required

  bool enabled() const { return !certificate.empty() || !key.empty() || !client_ca.empty(); }
};

// The contents of the files.
struct CertificateSet {
  std::string chain;
  std::string key;
  std::string client_ca;  // empty if no client certificate is required
  absl::Time expiry;      // of the first certificate of the chain to expire
  absl::Time ca_expiry;   // of the last of the authorities to expire; infinite without any
};

// Reads and checks the files: they must contain what a handshake needs, fit together, and not have
// expired at `now`. Errors: InvalidArgument, in one line that names the file.
absl::StatusOr<CertificateSet> ReadCertificates(const TlsOptions& tls, absl::Time now);

// Thread-safe.
class CertificateStore {
 public:
  // Calls `on_reload` for each reload, OK or failed; after a failure the last good files stay.
  // Errors: see ReadCertificates.
  static absl::StatusOr<std::shared_ptr<CertificateStore>> Make(
      const TlsOptions& tls, std::function<void(const absl::Status&)> on_reload);

  std::shared_ptr<const CertificateSet> current() const;

  // Reads the files again if one of them changed, or in any case if `anyway`.
  void Look(bool anyway);

 private:
  using States = std::array<FileState, 3>;

  CertificateStore(const TlsOptions& tls, std::function<void(const absl::Status&)> on_reload)
      : tls_(tls), on_reload_(std::move(on_reload)) {}

  States StatesNow() const;

  const TlsOptions tls_;
  const std::function<void(const absl::Status&)> on_reload_;
  Mutex looking_;  // while files are read: what was read first must not replace what came later
  States states_ TRAVERSE_GUARDED_BY(looking_);
  mutable Mutex mutex_;
  std::shared_ptr<const CertificateSet> current_ TRAVERSE_GUARDED_BY(mutex_);
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_ACCESS_CERTIFICATES_H_
