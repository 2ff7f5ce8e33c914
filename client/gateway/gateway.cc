#include "client/gateway/gateway.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <utility>

#include "absl/time/clock.h"
#include "client/gateway/grpc/file_call.h"

namespace traverse::gateway {
namespace {

constexpr char kServiceName[] = "traverse.v1.GcodeService";
// How often the gateway checks files that operators may change.
constexpr auto kLookEvery = std::chrono::seconds(1);

}  // namespace

absl::StatusOr<std::unique_ptr<Gateway>> Gateway::Start(const GatewayOptions& options) {
  if (!options.tls.enabled()) {
    for (const std::string& listen : {options.listen_http, options.listen}) {
      if (listen.empty()) continue;
      if (absl::Status status = CheckPlaintext(listen, options.insecure); !status.ok()) {
        return status;
      }
    }
  }
  std::unique_ptr<Gateway> gateway(new Gateway());
  try {
    if (absl::Status status = gateway->OpenService(options); !status.ok()) return status;
  } catch (const std::exception& error) {
    return absl::UnavailableError(error.what());
  }
  if (options.tls.enabled()) {
    if (absl::Status status = gateway->core_->files.StartTls(options.tls); !status.ok())
      return status;
  }
  if (absl::Status status = gateway->OpenPrinters(options); !status.ok()) return status;
  gateway->router_ = std::make_unique<Router>(*gateway->core_, gateway->printers_.get());
  if (absl::Status status = gateway->StartGrpc(options); !status.ok()) return status;
  if (absl::Status status = gateway->StartHttp(options); !status.ok()) return status;
  gateway->look_.emplace(kLookEvery,
                         [core = gateway->core_.get()] { core->files.Reload(/*anyway=*/false); });
  return gateway;
}

absl::Status Gateway::OpenService(const GatewayOptions& options) {
  std::shared_ptr<grpc::Channel> channel;
  if (options.servers.empty()) {
    absl::StatusOr<std::unique_ptr<EmbeddedService>> embedded =
        EmbeddedService::Start(options.threads);
    if (!embedded.ok()) return embedded.status();
    embedded_ = *std::move(embedded);
    channel = embedded_->channel();
  } else {
    absl::StatusOr<std::shared_ptr<grpc::Channel>> connected =
        ConnectTo(options.servers, options.connect);
    if (!connected.ok()) return connected.status();
    channel = *std::move(connected);
  }
  absl::StatusOr<std::unique_ptr<Core>> core =
      Core::Make(options.core, std::move(channel), options.token);
  if (!core.ok()) return core.status();
  core_ = *std::move(core);
  return absl::OkStatus();
}

absl::Status Gateway::OpenPrinters(const GatewayOptions& options) {
  if (options.printers_file.empty()) return absl::OkStatus();
  absl::StatusOr<PrintersConfig> config = ReadPrinters(options.printers_file);
  if (!config.ok()) return config.status();
  printers_ = std::make_unique<PrinterApi>(
      *core_, PrinterApiOptions{*std::move(config), options.upload_deadline, options.upstream});
  return absl::OkStatus();
}

MemoryWatch::Hooks Gateway::MemoryHooks() {
  return {
      .set_short = [queue = core_->queue.get()](bool is_short) { queue->SetMemoryShort(is_short); },
      .on_cut =
          [log = core_->files.log.get()] {
            log->Event(JobLog::Level::kWarning, "connection_cut", {{"message", "memory is short"}});
          }};
}

absl::Status Gateway::StartGrpc(const GatewayOptions& options) {
  if (options.listen.empty()) {
    if (options.max_memory != INT64_MAX) {
      memory_watch_.emplace(options.max_memory, nullptr, MemoryHooks());
    }
    return absl::OkStatus();
  }
  grpc_service_ =
      std::make_unique<GcodeGrpcService>(*core_, options.http.idle_time, options.http.body_time);
  absl::StatusOr<std::unique_ptr<Listener>> listener = Listener::Open(
      {.listen = options.listen,
       .limits = options.connections,
       .max_message_bytes = kMaxMessageBytes,
       .max_memory = options.max_memory},
      core_->files.certificates,
      {.end_job = [service = grpc_service_.get()](
                      const std::string& peer, Excess) { return service->EndOversizeCall(peer); },
       .memory = MemoryHooks()});
  if (!listener.ok()) return listener.status();
  listener_ = *std::move(listener);
  core_->connections = listener_->connections();
  return listener_->Serve(*grpc_service_, kServiceName);
}

absl::Status Gateway::StartHttp(const GatewayOptions& options) {
  absl::StatusOr<std::unique_ptr<HttpServer>> http = HttpServer::Start(
      {options.listen_http, core_->files.certificates, options.http},
      [router = router_.get()](const HttpRequest& request) { return router->Handle(request); });
  if (!http.ok()) return http.status();
  http_ = *std::move(http);
  if (options.metrics_listen.empty()) return absl::OkStatus();
  absl::StatusOr<std::unique_ptr<MetricsHttp>> metrics = MetricsHttp::Start(
      options.metrics_listen, {.metrics = [core = core_.get()] { return core->MetricsText(); },
                               .ready = [core = core_.get()] { return !core->queue->draining(); }});
  if (!metrics.ok()) return metrics.status();
  metrics_ = *std::move(metrics);
  return absl::OkStatus();
}

bool Gateway::Drain(absl::Duration timeout) {
  const absl::Time end = absl::Now() + timeout;
  core_->queue->StartDraining();
  if (listener_ != nullptr) listener_->StopServing();
  constexpr absl::Duration kLook = absl::Milliseconds(5);
  const auto is_done = [this] {
    return core_->queue->requests() == 0 && core_->jobs->unfetched() == 0;
  };
  while (!is_done() && absl::Now() < end) absl::SleepFor(kLook);
  const bool all_done = is_done();
  http_->Drain(all_done ? std::max(absl::Seconds(5), end - absl::Now()) : absl::Milliseconds(100));
  return all_done;
}

Gateway::~Gateway() {
  look_.reset();
  if (core_ != nullptr) {
    core_->queue->StartDraining();
    core_->jobs->CancelAll();
  }
  metrics_ = nullptr;
  http_ = nullptr;
  memory_watch_.reset();
  if (listener_ != nullptr) listener_->Shutdown(absl::Milliseconds(200));
  if (core_ != nullptr) core_->jobs->CancelAll();  // those whose files came meanwhile
}

}  // namespace traverse::gateway
