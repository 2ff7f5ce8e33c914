// The operator's files that a daemon reads or writes while it runs: log, tokens,
// certificates.

#ifndef TRAVERSE_SERVER_OPS_OPERATOR_FILES_H_
#define TRAVERSE_SERVER_OPS_OPERATOR_FILES_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "server/access/auth.h"
#include "server/access/certificates.h"
#include "server/ops/job_log.h"

namespace traverse {

// Thread-safe after StartAuth and StartTls.
class OperatorFiles {
 public:
  // Calls `on_failure` for each file that could not be reloaded: "tokens", "certificate" or "log".
  // The last good one stays in use.
  OperatorFiles(std::unique_ptr<JobLog> log, std::function<void(const std::string&)> on_failure);

  // Set up `auth` and `certificates`, before the first call. Errors: see Authenticator::Make and
  // CertificateStore::Make.
  absl::Status StartAuth(const AuthOptions& options);
  absl::Status StartTls(const TlsOptions& options);

  // Reloads the tokens and certificates that have changed; with `anyway` all of them, and reopens
  // the log file.
  void Reload(bool anyway);

  const std::unique_ptr<JobLog> log;
  std::unique_ptr<Authenticator> auth;
  std::shared_ptr<CertificateStore> certificates;  // null without TLS

 private:
  // Reports the reload of `what`.
  void OnReload(const std::string& what, const absl::Status& status);

  const std::function<void(const std::string&)> on_failure_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_OPERATOR_FILES_H_
