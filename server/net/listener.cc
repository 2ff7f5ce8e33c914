#include "server/net/listener.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/impl/server_builder_plugin.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <mutex>
#include <thread>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/access/credentials.h"
#include "server/net/call_counter.h"

namespace traverse {
namespace {

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

// From the first byte to the settings of HTTP/2, TLS included.
constexpr int kHandshakeMilliseconds = 20'000;

// Calls that a connection may have here for each stream that it may have open: they are not done
// with at once when their streams end.
constexpr int64_t kCallsOfStreams = 3;

// How often to check how long calls wait, and how long they may before somebody is turned away.
constexpr auto kLagEvery = std::chrono::milliseconds(20);
constexpr std::chrono::duration<double> kMostLag = std::chrono::milliseconds(50);

int Milliseconds(absl::Duration duration) {
  return static_cast<int>(std::clamp<int64_t>(absl::ToInt64Milliseconds(duration), 0, INT_MAX));
}

void SetConnectionLimits(const ConnectionLimits& limits, grpc::ServerBuilder& builder) {
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, limits.max_streams);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshakeMilliseconds);
  // Pings and resets that are of no use end the connection.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PING_STRIKES, 2);
  // Those of a client that waits are of use: it learns that the server is gone. By default gRPC
  // wants five minutes between them.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                             Milliseconds(limits.client_ping_interval));
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, limits.max_header_bytes);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, Milliseconds(limits.keepalive_time));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, Milliseconds(limits.keepalive_timeout));
  // A caller may wait for long for an answer; without this the pings stop after two.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  // A call sends no more than the first window before it hears that it is refused; the rest of a
  // message that is wanted has room at once.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  if (limits.max_age != absl::InfiniteDuration()) {
    builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS, Milliseconds(limits.max_age));
  }
}

// gRPC has a thread for each open call of reflection, the one blocking service here: thousands of
// open calls would take as many threads. More than these are refused.
int MaxBlockingThreads() {
  constexpr int kOpenReflections = 16;
  return 2 * static_cast<int>(std::thread::hardware_concurrency()) + kOpenReflections;
}

void SetMemoryLimits(int64_t max_memory, grpc::ServerBuilder& builder) {
  // gRPC checks the size when it has the whole message. Connections watches what may come, and the
  // readers of a message check what has come and give the error.
  builder.SetMaxReceiveMessageSize(INT_MAX);
  // A few bytes may unpack to any number, which nothing has counted.
  for (const auto algorithm : {GRPC_COMPRESS_DEFLATE, GRPC_COMPRESS_GZIP}) {
    builder.SetCompressionAlgorithmSupportStatus(algorithm, false);
  }
  grpc::ResourceQuota quota("traverse");
  if (max_memory != INT64_MAX) quota.Resize(static_cast<size_t>(max_memory));
  quota.SetMaxThreads(MaxBlockingThreads());
  builder.SetResourceQuota(quota);
}

// Unfinished messages of all callers may take this part of the memory.
constexpr int64_t kPendingPart = 4;

std::shared_ptr<grpc::ServerCredentials> MakeCredentials(
    const std::shared_ptr<CertificateStore>& certificates) {
  return certificates == nullptr ? grpc::InsecureServerCredentials()
                                 : MakeTlsCredentials(certificates);
}

bool IsTcp(const std::string& listen) {
  return !listen.empty() && !absl::StartsWith(listen, "unix");
}

}  // namespace

Listener::Listener(const ListenerOptions& options, std::shared_ptr<CertificateStore> certificates,
                   Hooks hooks)
    : options_(options), certificates_(std::move(certificates)), hooks_(std::move(hooks)) {}

Listener::~Listener() { Shutdown(absl::ZeroDuration()); }

absl::StatusOr<std::unique_ptr<Listener>> Listener::Open(
    const ListenerOptions& options, std::shared_ptr<CertificateStore> certificates, Hooks hooks) {
  std::unique_ptr<Listener> listener(
      new Listener(options, std::move(certificates), std::move(hooks)));
  if (!IsTcp(options.listen)) return listener;
  if (absl::Status status = listener->OpenPort(); !status.ok()) return status;
  return listener;
}

absl::Status Listener::OpenPort() {
  ConnectionRules rules;
  rules.max_connections = options_.limits.max_connections;
  rules.files_part = options_.limits.files_part;
  // Twice what a message may have: a longer one that comes to its end gets a proper error.
  rules.job_bytes = 2 * options_.max_message_bytes;
  if (options_.max_memory != INT64_MAX) rules.all_bytes = options_.max_memory / kPendingPart;
  rules.max_calls =
      static_cast<int>(std::min<int64_t>(INT_MAX, kCallsOfStreams * options_.limits.max_streams));
  rules.peer_timeout = absl::ToChronoMilliseconds(options_.limits.keepalive_timeout);
  absl::StatusOr<std::unique_ptr<Connections>> connections = Connections::Listen(
      options_.listen, rules,
      {.hand_over =
           [this](int socket, int hand) {
             grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
             parameters.fd = socket;
             acceptors_[static_cast<size_t>(hand)]->HandleNewConnection(&parameters);
           },
       .end_job = hooks_.end_job});
  if (!connections.ok()) return connections.status();
  connections_ = *std::move(connections);
  port_ = connections_->port();
  return absl::OkStatus();
}

void Listener::AddPort(grpc::ServerBuilder& builder) {
  if (connections_ == nullptr) {
    credentials_ = MakeCredentials(certificates_);
    builder.AddListeningPort(options_.listen, credentials_, &port_);
    return;
  }
  for (int hand = 0; hand < Connections::kHands; ++hand) {
    acceptors_.push_back(builder.experimental().AddExternalConnectionAcceptor(
        grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD,
        MakeCredentials(certificates_)));
  }
}

void Listener::CountCalls(const std::string& name, grpc::ServerBuilder& builder) {
  const std::string reported =
      options_.service_reports_calls ? absl::StrCat("/", name, "/") : std::string();
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> counters;
  counters.push_back(std::make_unique<CallCounter>(*connections_, reported));
  builder.experimental().SetInterceptorCreators(std::move(counters));
}

absl::Status Listener::Serve(grpc::Service& service, const std::string& name) {
  InitGrpcPlugins();
  grpc::ServerBuilder builder;
  SetMemoryLimits(options_.max_memory, builder);
  SetConnectionLimits(options_.limits, builder);
  if (!options_.reflection) builder.SetOption(std::make_unique<NoReflection>());
  if (!options_.listen.empty()) AddPort(builder);
  if (connections_ != nullptr) CountCalls(name, builder);
  builder.RegisterService(&service);
  server_ = builder.BuildAndStart();
  if (server_ == nullptr || (!options_.listen.empty() && port_ == 0)) {
    return absl::UnavailableError(absl::StrCat("cannot listen on ", options_.listen));
  }
  if (options_.max_memory != INT64_MAX && hooks_.memory.set_short) {
    memory_watch_.emplace(options_.max_memory, connections_.get(), hooks_.memory);
  }
  if (connections_ != nullptr) {
    connections_->Start();
    WatchLag();
  }
  server_->GetHealthCheckService()->SetServingStatus(name, true);
  return absl::OkStatus();
}

void Listener::StopServing() { server_->GetHealthCheckService()->SetServingStatus(false); }

void Listener::WatchLag() {
  lag_probe_.emplace(*server_);
  watch_lag_.emplace(kLagEvery, [this, late = 0]() mutable {
    late = lag_probe_->Look() > kMostLag ? late + 1 : 0;
    // Once is a machine that stood still.
    if (late >= 2 && connections_->TurnAwayBusiest()) late = 0;
  });
}

void Listener::Shutdown(absl::Duration grace) {
  watch_lag_.reset();
  lag_probe_.reset();
  memory_watch_.reset();
  if (connections_ != nullptr) connections_->StopListening();
  if (server_ == nullptr) return;
  server_->Shutdown(std::chrono::system_clock::now() + absl::ToChronoMicroseconds(grace));
  server_->Wait();
  server_.reset();
}

}  // namespace traverse
