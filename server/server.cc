#include "server/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/impl/server_builder_plugin.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"

namespace traverse {
namespace {

constexpr char kServiceName[] = "traverse.v1.RouteOptimizerService";

// Once a process: gRPC keeps both as globals, read when a server is built.
void InitGrpcPlugins() {
  static std::once_flag once;
  std::call_once(once, [] {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  });
}

// Takes reflection out of the server being built, as the plugin is there for all servers.
class NoReflection : public grpc::ServerBuilderOption {
 public:
  void UpdateArguments(grpc::ChannelArguments* /*arguments*/) override {}
  void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
    plugins->erase(std::remove_if(plugins->begin(), plugins->end(),
                                  [](const auto& plugin) {
                                    return plugin->name() == "proto_server_reflection";
                                  }),
                   plugins->end());
  }
};

// Longer than any drain, and short enough to be added to a time.
constexpr absl::Duration kForever = absl::Hours(24 * 365);

int Milliseconds(absl::Duration duration) {
  return static_cast<int>(std::clamp<int64_t>(absl::ToInt64Milliseconds(duration), 0, INT_MAX));
}

void SetConnectionLimits(const ConnectionLimits& limits, grpc::ServerBuilder& builder) {
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, limits.max_streams);
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, limits.max_header_bytes);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, Milliseconds(limits.keepalive_time));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, Milliseconds(limits.keepalive_timeout));
  // A caller may wait for long for a layer; without this the pings stop after two.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  if (limits.max_age != absl::InfiniteDuration()) {
    builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS, Milliseconds(limits.max_age));
  }
}

// For calls that have ended to be done with, at the end of the server.
constexpr absl::Duration kGrace = absl::Seconds(2);

// For calls that were on their way when the port closed: they are refused as draining refuses them,
// rather than cut off.
constexpr absl::Duration kLastCalls = absl::Milliseconds(200);

// Waits until `condition` holds, for `timeout` at most. Returns whether it does.
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
  if (absl::Status status = server->core_.StartAuth(options.service.auth); !status.ok()) {
    return status;
  }
  if (absl::Status status = server->Build(options); !status.ok()) return status;
  return server;
}

absl::Status Server::Build(const ServerOptions& options) {
  InitGrpcPlugins();
  grpc::ServerBuilder builder;
  builder.SetMaxReceiveMessageSize(
      static_cast<int>(std::min<int64_t>(options.service.limits.max_message_bytes, INT_MAX)));
  // Else a second server on the same port would take half of the connections, instead of failing.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  if (!options.reflection) builder.SetOption(std::make_unique<NoReflection>());
  SetConnectionLimits(options.connections, builder);
  int port = 0;
  if (!options.listen.empty()) {
    absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> credentials =
        MakeServerCredentials(options.tls, options.listen, options.insecure);
    if (!credentials.ok()) return credentials.status();
    builder.AddListeningPort(options.listen, *credentials, &port);
  }
  builder.RegisterService(&service_);
  server_ = builder.BuildAndStart();
  if (server_ == nullptr || (!options.listen.empty() && port == 0)) {
    return absl::UnavailableError(absl::StrCat("cannot listen on ", options.listen));
  }
  port_ = port;
  server_->GetHealthCheckService()->SetServingStatus(kServiceName, true);
  if (options.metrics_listen.empty()) return absl::OkStatus();
  absl::StatusOr<std::unique_ptr<MetricsHttp>> metrics = MetricsHttp::Start(
      options.metrics_listen, {.metrics = [this] { return core_.MetricsText(); },
                               .ready = [this] { return !core_.admission.draining(); }});
  if (!metrics.ok()) return metrics.status();
  metrics_ = *std::move(metrics);
  return absl::OkStatus();
}

Server::~Server() {
  core_.admission.StartDraining();
  core_.AbortAll(absl::UnavailableError("the server has ended; ask another one"));
  if (server_ != nullptr) WaitFor(kGrace, [this] { return core_.calls() == 0; });
  Shutdown(absl::ZeroDuration());
}

std::shared_ptr<grpc::Channel> Server::InProcessChannel(const grpc::ChannelArguments& arguments) {
  return server_->InProcessChannel(arguments);
}

bool Server::Drain(absl::Duration timeout) {
  core_.admission.StartDraining();
  server_->GetHealthCheckService()->SetServingStatus(false);
  const bool all_done = WaitFor(timeout, [this] { return core_.admission.jobs() == 0; });
  if (!all_done) {
    core_.AbortAll(absl::UnavailableError(
        "the server is shutting down; ask another one for the layers that are missing"));
  }
  // The last messages and statuses are on their way out; a caller who does not read them loses
  // them.
  WaitFor(kGrace, [this] { return core_.calls() == 0; });
  Shutdown(kLastCalls);
  return all_done;
}

void Server::Shutdown(absl::Duration grace) {
  if (server_ == nullptr) return;
  server_->Shutdown(std::chrono::system_clock::now() + absl::ToChronoMicroseconds(grace));
  server_->Wait();
}

}  // namespace traverse
