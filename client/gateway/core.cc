#include "client/gateway/core.h"

#include <utility>

namespace traverse::gateway {

Core::Core(const CoreOptions& made_with)
    : options(made_with),
      files(options.log ? std::make_unique<JobLog>(options.log_path) : std::make_unique<JobLog>(),
            [this](const std::string& what) { metrics.CountReloadFailure(what); }) {}

absl::StatusOr<std::unique_ptr<Core>> Core::Make(const CoreOptions& options,
                                                 std::shared_ptr<grpc::Channel> channel,
                                                 std::string token) {
  auto core = std::make_unique<Core>(options);
  if (absl::Status status = core->files.StartAuth(options.auth); !status.ok()) return status;
  absl::StatusOr<std::unique_ptr<Spool>> spool =
      Spool::Open(options.spool_folder, options.max_spool_bytes);
  if (!spool.ok()) return spool.status();
  core->spool = *std::move(spool);
  core->client = std::make_unique<OptimizerClient>(std::move(channel), std::move(token));
  core->worker = std::make_unique<FileWorker>(*core->client, *core->spool, options.max_file_bytes);
  core->queue = std::make_unique<WorkQueue>(options.work);
  return core;
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
