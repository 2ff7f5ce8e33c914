#include "client/gateway/core.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/gateway/work/guarded.h"

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
  absl::StatusOr<std::unique_ptr<JobStore>> jobs = JobStore::Make(options.jobs, *core);
  if (!jobs.ok()) return jobs.status();
  core->jobs = *std::move(jobs);
  core->queue = std::make_unique<WorkQueue>(options.work);
  return core;
}

namespace {

absl::StatusOr<int64_t> MemoryForAll(const std::vector<std::shared_ptr<const SpoolFile>>& files,
                                     FileUse use, uint64_t max_file_bytes,
                                     int64_t max_memory_bytes) {
  int64_t sum = 0;
  for (const auto& file : files) {
    const absl::StatusOr<int64_t> bytes = MemoryFor(*file, use, max_file_bytes);
    if (!bytes.ok()) return bytes;
    sum += *bytes;
  }
  if (sum <= max_memory_bytes) return sum;
  return absl::OutOfRangeError(
      absl::StrFormat("this file may need %d MiB of memory, but this gateway has %d", sum >> 20,
                      max_memory_bytes >> 20));
}

}  // namespace

void Core::Submit(std::shared_ptr<WorkQueue::Ticket> ticket,
                  std::vector<std::shared_ptr<const SpoolFile>> files,
                  const gcode::WorkLimit& limit, Task work, FileUse use) {
  const bool at_once = std::all_of(files.begin(), files.end(),
                                   [](const auto& file) { return IsMeasuredAtOnce(*file); });
  auto submit = [this, ticket, files, work = std::move(work), use, limit] {
    if (limit.Ended()) return work(absl::OkStatus());
    const absl::StatusOr<int64_t> memory = Guarded([&] {
      return MemoryForAll(files, use, options.max_file_bytes, queue->max_memory_bytes());
    });
    if (!memory.ok()) return work(memory.status());
    queue->Submit(
        ticket, *memory, [work] { work(absl::OkStatus()); }, limit);
  };
  if (at_once) return submit();
  // Going through files to measure them takes time, and callers must not wait for it.
  int64_t to_measure = 0;
  for (const auto& file : files) to_measure += MemoryToMeasure(*file);
  queue->Submit(ticket, std::min(to_measure, queue->max_memory_bytes()), std::move(submit), limit);
}

std::string Core::MetricsText() {
  GatewayMetrics::Gauges gauges;
  gauges.requests = queue->requests();
  gauges.waiting = queue->waiting();
  gauges.running = queue->running();
  gauges.work_bytes = static_cast<double>(queue->memory_bytes());
  gauges.spool_bytes = static_cast<double>(spool->used_bytes());
  gauges.jobs = jobs->kept();
  gauges.jobs_unfetched = jobs->unfetched();
  gauges.ready = queue->draining() ? 0.0 : 1.0;
  if (connections != nullptr) {
    gauges.connections = connections->open();
    gauges.receiving_bytes = static_cast<double>(connections->pending_bytes());
    gauges.connections_cut = static_cast<double>(connections->cut());
  }
  return metrics.Text(gauges);
}

}  // namespace traverse::gateway
