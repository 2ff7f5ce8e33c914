// What all interfaces of the gateway share: who may call, the spool, the queue, the service behind
// it, metrics and log.

#ifndef TRAVERSE_CLIENT_GATEWAY_CORE_H_
#define TRAVERSE_CLIENT_GATEWAY_CORE_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/api/embedded.h"
#include "client/api/optimizer_client.h"
#include "client/gateway/gateway_metrics.h"
#include "client/gateway/jobs/job_store.h"
#include "client/gateway/spool/spool.h"
#include "client/gateway/work/file_memory.h"
#include "client/gateway/work/file_worker.h"
#include "client/gateway/work/work_queue.h"
#include "client/gcode/work_limit.h"
#include "server/access/auth.h"
#include "server/net/connections.h"
#include "server/ops/operator_files.h"

namespace traverse::gateway {

struct CoreOptions {
  std::string spool_folder = "/tmp";
  uint64_t max_spool_bytes = uint64_t{4} << 30;
  uint64_t max_file_bytes = uint64_t{256} << 20;
  absl::Duration max_time = absl::Minutes(10);  // for one file, from the end of its upload
  WorkLimits work;
  JobLimits jobs;
  AuthOptions auth;
  std::vector<std::string> allowed_hosts;  // names that IsOwnHost accepts besides its own
  std::string log_path;                    // empty: stderr
  bool log = true;
};

// Lives as long as the gateway. All of it is thread-safe.
struct Core {
  // `channel` leads to the service; `token` goes with calls there. Errors: InvalidArgument for an
  // unusable token file, Unavailable for a spool or ids. Throws what the constructor of JobLog
  // throws.
  static absl::StatusOr<std::unique_ptr<Core>> Make(const CoreOptions& options,
                                                    std::shared_ptr<grpc::Channel> channel,
                                                    std::string token);

  // Calls `work` when there are a worker and the memory that such work on `files` may take. Calls
  // it with an error if they need more than there is at all (OutOfRange), or cannot be read.
  // `ticket` and the files live until then. When `limit` has ended `work` waits for nothing, and
  // sees to it.
  using Task = std::function<void(const absl::Status&)>;
  void Submit(std::shared_ptr<WorkQueue::Ticket> ticket,
              std::vector<std::shared_ptr<const SpoolFile>> files, const gcode::WorkLimit& limit,
              Task work, FileUse use = FileUse::kRewrite);

  // The text of /metrics.
  std::string MetricsText();

  // Throws what the constructor of JobLog throws.
  explicit Core(const CoreOptions& made_with);

  const CoreOptions options;
  GatewayMetrics metrics;
  OperatorFiles files;
  std::unique_ptr<Spool> spool;
  std::unique_ptr<OptimizerClient> client;
  std::unique_ptr<FileWorker> worker;
  Connections* connections = nullptr;  // of gRPC, if it listens; outlives the calls
  std::unique_ptr<JobStore> jobs;
  std::unique_ptr<WorkQueue> queue;  // last: its tasks use the other members
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_CORE_H_
