#include "server/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/impl/server_builder_plugin.h>
#include <grpcpp/resource_quota.h>
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

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/net/other_calls.h"

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

// Takes reflection out of the server being built, because the plugin applies to all servers.
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

// From the first byte to the settings of HTTP/2, TLS included.
constexpr int kHandshakeMilliseconds = 20'000;

int Milliseconds(absl::Duration duration) {
  return static_cast<int>(std::clamp<int64_t>(absl::ToInt64Milliseconds(duration), 0, INT_MAX));
}

void SetConnectionLimits(const ConnectionLimits& limits, grpc::ServerBuilder& builder) {
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, limits.max_streams);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshakeMilliseconds);
  // Pings and resets that are of no use end the connection.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PING_STRIKES, 2);
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, limits.max_header_bytes);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, Milliseconds(limits.keepalive_time));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, Milliseconds(limits.keepalive_timeout));
  // A caller may wait for long for a layer; without this the pings stop after two.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  // A call sends no more than the first window before it hears that it is refused; the rest of a
  // message that is wanted has room at once.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  if (limits.max_age != absl::InfiniteDuration()) {
    builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS, Milliseconds(limits.max_age));
  }
}

// Calls that a connection may have here for each stream that it may have open: they are not done
// with at once when their streams end.
constexpr int64_t kCallsOfStreams = 3;

// gRPC has a thread for each open call of reflection, the one blocking service here: thousands of
// open calls would take as many threads. More than these are refused.
int MaxBlockingThreads() {
  constexpr int kOpenReflections = 16;
  return 2 * static_cast<int>(std::thread::hardware_concurrency()) + kOpenReflections;
}

// How often to check the files that operators may change.
constexpr auto kLookEvery = std::chrono::seconds(1);

// How often to check how long calls wait, and how long they may before somebody is turned away.
constexpr auto kLagEvery = std::chrono::milliseconds(20);
constexpr std::chrono::duration<double> kMostLag = std::chrono::milliseconds(50);

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
  InitGrpcPlugins();
  grpc::ServerBuilder builder;
  // gRPC checks the size when it has the whole message. Connections watches what may come, and the
  // readers of a message check what has come and give the error.
  builder.SetMaxReceiveMessageSize(INT_MAX);
  // A few bytes may unpack to any number, which nothing has counted.
  for (const auto algorithm : {GRPC_COMPRESS_DEFLATE, GRPC_COMPRESS_GZIP}) {
    builder.SetCompressionAlgorithmSupportStatus(algorithm, false);
  }
  if (!options.reflection) builder.SetOption(std::make_unique<NoReflection>());
  SetConnectionLimits(options.connections, builder);
  grpc::ResourceQuota quota("traverse");
  if (options.max_memory != INT64_MAX) quota.Resize(static_cast<size_t>(options.max_memory));
  quota.SetMaxThreads(MaxBlockingThreads());
  builder.SetResourceQuota(quota);
  if (!options.listen.empty()) {
    if (absl::Status status = AddPort(options, builder); !status.ok()) return status;
  }
  core_.Watch(connections_.get(), options.max_memory);
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> others;
  others.push_back(std::make_unique<OtherCalls>(core_));
  builder.experimental().SetInterceptorCreators(std::move(others));
  builder.RegisterService(&service_);
  server_ = builder.BuildAndStart();
  if (server_ == nullptr || (!options.listen.empty() && port_ == 0)) {
    return absl::UnavailableError(absl::StrCat("cannot listen on ", options.listen));
  }
  if (connections_ != nullptr) {
    connections_->Start();
    WatchLag();
  }
  server_->GetHealthCheckService()->SetServingStatus(kServiceName, true);
  if (options.metrics_listen.empty()) return absl::OkStatus();
  absl::StatusOr<std::unique_ptr<MetricsHttp>> metrics = MetricsHttp::Start(
      options.metrics_listen, {.metrics = [this] { return core_.MetricsText(); },
                               .ready = [this] { return !core_.admission.draining(); },
                               .healthy = [this] { return core_.healthy(); }});
  if (!metrics.ok()) return metrics.status();
  metrics_ = *std::move(metrics);
  return absl::OkStatus();
}

absl::Status Server::AddPort(const ServerOptions& options, grpc::ServerBuilder& builder) {
  const auto make_credentials = [this] {
    return core_.files.certificates == nullptr ? grpc::InsecureServerCredentials()
                                               : MakeTlsCredentials(core_.files.certificates);
  };
  if (absl::StartsWith(options.listen, "unix")) {
    builder.AddListeningPort(options.listen, make_credentials(), &port_);
    return absl::OkStatus();
  }
  for (int hand = 0; hand < Connections::kHands; ++hand) {
    acceptors_.push_back(builder.experimental().AddExternalConnectionAcceptor(
        grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD,
        make_credentials()));
  }
  ConnectionRules rules;
  rules.max_connections = options.connections.max_connections;
  // Twice what a message may have: a longer one that comes to its end gets a proper error.
  rules.job_bytes = 2 * options.service.limits.max_message_bytes;
  rules.max_calls = static_cast<int>(
      std::min<int64_t>(INT_MAX, kCallsOfStreams * options.connections.max_streams));
  rules.peer_timeout = absl::ToChronoMilliseconds(options.connections.keepalive_timeout);
  absl::StatusOr<std::unique_ptr<Connections>> connections = Connections::Listen(
      options.listen, rules,
      {.hand_over =
           [this](int socket, int hand) {
             grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
             parameters.fd = socket;
             acceptors_[static_cast<size_t>(hand)]->HandleNewConnection(&parameters);
           },
       .end_job = [this](const std::string& peer) { return core_.EndOversizeJob(peer); }});
  if (!connections.ok()) return connections.status();
  connections_ = *std::move(connections);
  port_ = connections_->port();
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
  // The last messages and statuses are on their way; a caller who does not read them loses
  // them.
  WaitFor(kGrace, [this] { return core_.calls() == 0; });
  Shutdown(kLastCalls);
  return all_done;
}

void Server::WatchLag() {
  lag_probe_.emplace(*server_);
  watch_lag_.emplace(kLagEvery, [this, late = 0]() mutable {
    late = lag_probe_->Look() > kMostLag ? late + 1 : 0;
    // Once is a machine that stood still.
    if (late >= 2 && connections_->TurnAwayBusiest()) late = 0;
  });
}

void Server::Shutdown(absl::Duration grace) {
  watch_lag_.reset();
  lag_probe_.reset();
  if (connections_ != nullptr) connections_->StopListening();
  if (server_ == nullptr) return;
  server_->Shutdown(std::chrono::system_clock::now() + absl::ToChronoMicroseconds(grace));
  server_->Wait();
}

}  // namespace traverse
