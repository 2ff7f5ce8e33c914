#include "client/gateway/gateway.h"

#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>

#include <chrono>
#include <exception>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"

namespace traverse::gateway {
namespace {

constexpr char kServiceName[] = "traverse.v1.GcodeService";
// How often the gateway checks files that operators may change.
constexpr auto kLookEvery = std::chrono::seconds(1);

constexpr int kMaxMessageBytes = 5 << 20;  // a piece of a file has at most 4 MB

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

absl::Status Gateway::StartGrpc(const GatewayOptions& options) {
  if (options.listen.empty()) return absl::OkStatus();
  grpc::EnableDefaultHealthCheckService(true);
  grpc_service_ = std::make_unique<GcodeGrpcService>(*core_, options.http.idle_time);
  grpc::ServerBuilder builder;
  builder.SetMaxReceiveMessageSize(kMaxMessageBytes);
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, 100);
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE,
                             static_cast<int>(options.http.max_head_bytes));
  builder.AddListeningPort(options.listen,
                           core_->files.certificates == nullptr
                               ? grpc::InsecureServerCredentials()
                               : MakeTlsCredentials(core_->files.certificates),
                           &grpc_port_);
  builder.RegisterService(grpc_service_.get());
  grpc_ = builder.BuildAndStart();
  if (grpc_ == nullptr || grpc_port_ == 0) {
    return absl::UnavailableError(absl::StrCat("cannot listen on ", options.listen));
  }
  grpc_->GetHealthCheckService()->SetServingStatus(kServiceName, true);
  return absl::OkStatus();
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
  if (grpc_ != nullptr) grpc_->GetHealthCheckService()->SetServingStatus(false);
  constexpr absl::Duration kLook = absl::Milliseconds(5);
  while (core_->queue->requests() > 0 && absl::Now() < end) absl::SleepFor(kLook);
  const bool all_done = core_->queue->requests() == 0;
  http_->Drain(all_done ? absl::Seconds(5) : absl::Milliseconds(100));
  return all_done;
}

Gateway::~Gateway() {
  look_.reset();
  if (core_ != nullptr) core_->queue->StartDraining();
  metrics_ = nullptr;
  http_ = nullptr;
  if (grpc_ != nullptr) {
    grpc_->Shutdown(std::chrono::system_clock::now() + std::chrono::milliseconds(200));
    grpc_->Wait();
  }
}

}  // namespace traverse::gateway
