#include "client/gateway/core.h"

#include <utility>

namespace traverse::gateway {

absl::StatusOr<std::unique_ptr<Core>> Core::Make(const CoreOptions& options,
                                                 std::shared_ptr<grpc::Channel> channel,
                                                 std::string token) {
  auto core = std::make_unique<Core>();
  core->options = options;
  core->log = options.log ? std::make_unique<JobLog>(options.log_path) : std::make_unique<JobLog>();
  absl::StatusOr<std::unique_ptr<Authenticator>> auth = Authenticator::Make(
      options.auth,
      [core = core.get()](const absl::Status& status) { core->OnReload("tokens", status); });
  if (!auth.ok()) return auth.status();
  core->auth = *std::move(auth);
  absl::StatusOr<std::unique_ptr<Spool>> spool =
      Spool::Open(options.spool_folder, options.max_spool_bytes);
  if (!spool.ok()) return spool.status();
  core->spool = *std::move(spool);
  core->client = std::make_unique<OptimizerClient>(std::move(channel), std::move(token));
  core->worker = std::make_unique<FileWorker>(*core->client, *core->spool, options.max_file_bytes);
  core->queue = std::make_unique<WorkQueue>(options.work);
  return core;
}

void Core::OnReload(const std::string& what, const absl::Status& status) {
  if (!status.ok()) metrics.CountReloadFailure(what);
  log->Event(status.ok() ? JobLog::Level::kInfo : JobLog::Level::kError, what + "_reloaded",
             {{"result", status.ok() ? "ok" : std::string(status.message())}});
}

absl::Status Core::StartTls(const TlsOptions& tls) {
  absl::StatusOr<std::shared_ptr<CertificateStore>> made = CertificateStore::Make(
      tls, [this](const absl::Status& status) { OnReload("certificate", status); });
  if (!made.ok()) return made.status();
  certificates = *std::move(made);
  return absl::OkStatus();
}

void Core::Reload(bool anyway) {
  if (anyway && !log->Reopen()) {
    metrics.CountReloadFailure("log");
    log->Event(JobLog::Level::kError, "log_reopened",
               {{"result", "the file cannot be opened; the one that was open stays"}});
  }
  auth->Look(anyway);
  if (certificates != nullptr) certificates->Look(anyway);
}

std::string Core::MetricsText() {
  return metrics.Text({.requests = queue->requests(),
                       .waiting = queue->waiting(),
                       .running = queue->running(),
                       .work_bytes = static_cast<double>(queue->memory_bytes()),
                       .spool_bytes = static_cast<double>(spool->used_bytes()),
                       .ready = queue->draining() ? 0.0 : 1.0});
}

}  // namespace traverse::gateway
