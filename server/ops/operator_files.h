// The files of an operator that a daemon reads or writes while it runs: the log, tokens,
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
  // `on_failure` is told of each file that could not be read or opened anew, "tokens",
  // "certificate" or "log": what was there before stays.
  OperatorFiles(std::unique_ptr<JobLog> log, std::function<void(const std::string&)> on_failure);

  // Set up `auth` and `certificates`; before the first call. Errors as of Authenticator::Make and
  // CertificateStore::Make.
  absl::Status StartAuth(const AuthOptions& options);
  absl::Status StartTls(const TlsOptions& options);

  // Reads anew what has changed of tokens and certificates; with `anyway` in any case, and the file
  // of the log is opened anew.
  void Reload(bool anyway);

  const std::unique_ptr<JobLog> log;
  std::unique_ptr<Authenticator> auth;
  std::shared_ptr<CertificateStore> certificates;  // null without TLS

 private:
  // Tells of the reload of `what`.
  void OnReload(const std::string& what, const absl::Status& status);

  const std::function<void(const std::string&)> on_failure_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_OPERATOR_FILES_H_
