#include "server/metrics_http.h"

#include <civetweb.h>

#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace traverse {
namespace {

constexpr char kPlainText[] = "text/plain; charset=utf-8";
constexpr char kMetricsText[] = "text/plain; version=0.0.4; charset=utf-8";

// Returns the HTTP status, as handlers do.
int Reply(mg_connection* connection, int status, const char* type, const std::string& body) {
  mg_printf(connection,
            "HTTP/1.1 %d %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\n"
            "Connection: close\r\n\r\n",
            status, mg_get_response_code_text(connection, status), type, body.size());
  mg_write(connection, body.data(), body.size());
  return status;
}

}  // namespace

int MetricsHttp::OnMetrics(mg_connection* connection, void* self) {
  return Reply(connection, 200, kMetricsText,
               static_cast<const MetricsHttp*>(self)->sources_.metrics());
}

int MetricsHttp::OnHealth(mg_connection* connection, void* /*self*/) {
  return Reply(connection, 200, kPlainText, "ok\n");
}

int MetricsHttp::OnReady(mg_connection* connection, void* self) {
  const bool ready = static_cast<const MetricsHttp*>(self)->sources_.ready();
  return Reply(connection, ready ? 200 : 503, kPlainText, ready ? "ready\n" : "draining\n");
}

absl::StatusOr<std::unique_ptr<MetricsHttp>> MetricsHttp::Start(const std::string& address,
                                                                Sources sources) {
  std::unique_ptr<MetricsHttp> http(new MetricsHttp(std::move(sources)));
  const char* options[] = {"listening_ports",
                           address.c_str(),
                           "num_threads",
                           "2",
                           "request_timeout_ms",
                           "5000",
                           "enable_directory_listing",
                           "no",
                           nullptr};
  mg_callbacks callbacks{};
  // Its own messages would be printed; what matters is in the status below.
  callbacks.log_message = [](const mg_connection*, const char*) { return 1; };
  http->context_ = mg_start(&callbacks, nullptr, options);
  if (http->context_ == nullptr) {
    return absl::UnavailableError(absl::StrCat("cannot listen on ", address, " for metrics"));
  }
  mg_set_request_handler(http->context_, "/metrics$", OnMetrics, http.get());
  mg_set_request_handler(http->context_, "/healthz$", OnHealth, http.get());
  mg_set_request_handler(http->context_, "/readyz$", OnReady, http.get());
  return http;
}

MetricsHttp::~MetricsHttp() {
  if (context_ != nullptr) mg_stop(context_);
}

int MetricsHttp::port() const {
  mg_server_port port{};
  return mg_get_server_ports(context_, 1, &port) == 1 ? port.port : 0;
}

}  // namespace traverse
