#include "server/ops/operator_files.h"

#include <utility>

namespace traverse {

OperatorFiles::OperatorFiles(std::unique_ptr<JobLog> log,
                             std::function<void(const std::string&)> on_failure)
    : log(std::move(log)), on_failure_(std::move(on_failure)) {}

absl::Status OperatorFiles::StartAuth(const AuthOptions& options) {
  absl::StatusOr<std::unique_ptr<Authenticator>> made = Authenticator::Make(
      options, [this](const absl::Status& status) { OnReload("tokens", status); });
  if (!made.ok()) return made.status();
  auth = *std::move(made);
  return absl::OkStatus();
}

absl::Status OperatorFiles::StartTls(const TlsOptions& options) {
  absl::StatusOr<std::shared_ptr<CertificateStore>> made = CertificateStore::Make(
      options, [this](const absl::Status& status) { OnReload("certificate", status); });
  if (!made.ok()) return made.status();
  certificates = *std::move(made);
  return absl::OkStatus();
}

void OperatorFiles::Reload(bool anyway) {
  if (anyway && !log->Reopen()) {
    on_failure_("log");
    log->Event(JobLog::Level::kError, "log_reopened",
               {{"result", "the file cannot be opened; the one that was open stays in use"}});
  }
  auth->Look(anyway);
  if (certificates != nullptr) certificates->Look(anyway);
}

void OperatorFiles::OnReload(const std::string& what, const absl::Status& status) {
  if (!status.ok()) on_failure_(what);
  log->Event(status.ok() ? JobLog::Level::kInfo : JobLog::Level::kError, what + "_reloaded",
             {{"result", status.ok() ? "ok" : std::string(status.message())}});
}

}  // namespace traverse
