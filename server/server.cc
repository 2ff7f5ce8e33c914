#include "server/server.h"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <exception>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

namespace traverse {
namespace {

constexpr char kServiceName[] = "traverse.v1.RouteOptimizerService";

// Longer than any drain, and short enough to be added to a time.
constexpr absl::Duration kForever = absl::Hours(24 * 365);

// How often to check the files that operators may change.
constexpr auto kLookEvery = std::chrono::seconds(1);

// For calls that have ended to be done with, at the end of the server.
constexpr absl::Duration kGrace = absl::Seconds(2);

// For calls that were on their way when the port closed: refuses them as draining does, rather than
// cutting them off.
constexpr absl::Duration kLastCalls = absl::Milliseconds(200);

// Waits until `condition` holds, at most for `timeout`. Returns whether it does.
bool WaitFor(absl::Duration timeout, const std::function<bool()>& condition) {
  const auto end =
      std::chrono::steady_clock::now() + absl::ToChronoNanoseconds(std::min(timeout, kForever));
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace

int UsableCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

ServerOptions ServerOptions::Embedded(int threads) {
  ServerOptions options;
  options.reflection = false;
  options.service.threads = threads > 0 ? threads : UsableCores();
  options.service.log = false;
  options.service.limits.max_message_bytes = INT_MAX;
  options.service.limits.max_layers_per_message = INT_MAX;
  options.service.limits.max_points_per_layer = INT_MAX;
  options.service.limits.idle_timeout = absl::InfiniteDuration();
  options.service.admission.max_jobs = INT_MAX;
  options.service.admission.max_jobs_per_caller = INT_MAX;
  options.service.admission.max_queued_points = INT64_MAX / 2;
  options.service.admission.max_queued_points_per_caller = INT64_MAX / 2;
  options.service.admission.max_wait = absl::InfiniteDuration();
  return options;
}

Server::Server(const ServerOptions& options) : core_(options.service), service_(core_) {}

absl::StatusOr<std::unique_ptr<Server>> Server::Start(const ServerOptions& options) {
  std::unique_ptr<Server> server;
  try {
    server.reset(new Server(options));
  } catch (const std::exception& error) {
    return absl::UnavailableError(error.what());
  }
  if (absl::Status status = server->core_.files.StartAuth(options.service.auth); !status.ok()) {
    return status;
  }
  if (options.tls.enabled()) {
    if (absl::Status status = server->core_.files.StartTls(options.tls); !status.ok())
      return status;
  } else if (!options.listen.empty()) {
    if (absl::Status status = CheckPlaintext(options.listen, options.insecure); !status.ok()) {
      return status;
    }
  }
  if (absl::Status status = server->Build(options); !status.ok()) return status;
  if (!options.tls.enabled() && options.service.auth.token_file.empty()) return server;
  server->look_.emplace(kLookEvery,
                        [core = &server->core_] { core->files.Reload(/*anyway=*/false); });
  return server;
}

absl::Status Server::Build(const ServerOptions& options) {
  const ListenerOptions listen = {.listen = options.listen,
                                  .limits = options.connections,
                                  .max_message_bytes = options.service.limits.max_message_bytes,
                                  .max_memory = options.max_memory,
                                  .reflection = options.reflection,
                                  .service_reports_calls = true};
  absl::StatusOr<std::unique_ptr<Listener>> listener = Listener::Open(
      listen, core_.files.certificates,
      {.end_job = [this](const std::string& peer,
                         Excess excess) { return core_.EndOversizeJob(peer, excess); },
       .memory = {}});  // the core watches it
  if (!listener.ok()) return listener.status();
  listener_ = *std::move(listener);
  core_.Watch(listener_->connections(), options.max_memory);
  if (absl::Status status = listener_->Serve(service_, kServiceName); !status.ok()) return status;
  if (options.metrics_listen.empty()) return absl::OkStatus();
  absl::StatusOr<std::unique_ptr<MetricsHttp>> metrics = MetricsHttp::Start(
      options.metrics_listen, {.metrics = [this] { return core_.MetricsText(); },
                               .ready = [this] { return !core_.admission.draining(); },
                               .healthy = [this] { return core_.healthy(); }});
  if (!metrics.ok()) return metrics.status();
  metrics_ = *std::move(metrics);
  return absl::OkStatus();
}

Server::~Server() {
  core_.admission.StartDraining();
  core_.AbortAll(absl::UnavailableError("the server has ended; ask another one"));
  if (listener_ == nullptr) return;
  WaitFor(kGrace, [this] { return core_.calls() == 0; });
  listener_->Shutdown(absl::ZeroDuration());
}

std::shared_ptr<grpc::Channel> Server::InProcessChannel(const grpc::ChannelArguments& arguments) {
  return listener_->server().InProcessChannel(arguments);
}

bool Server::Drain(absl::Duration timeout) {
  core_.admission.StartDraining();
  listener_->StopServing();
  const bool all_done = WaitFor(timeout, [this] { return core_.admission.jobs() == 0; });
  if (!all_done) {
    core_.AbortAll(absl::UnavailableError(
        "the server is shutting down; ask another one for the layers that are missing"));
  }
  // The last messages and statuses are on their way; a caller who does not read them loses
  // them.
  WaitFor(kGrace, [this] { return core_.calls() == 0; });
  listener_->Shutdown(kLastCalls);
  return all_done;
}

}  // namespace traverse
