#include "server/ops/metrics/metrics_http.h"

#include <microhttpd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdarg>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/net/open_files.h"
#include "server/net/tcp_listen.h"

namespace traverse {
namespace {

// Beyond this many the oldest is closed. The library's own limit, which would keep new ones out, is
// never reached.
constexpr int kKeptConnections = 64;
constexpr unsigned int kMaxConnections = 4 * kKeptConnections;

// Fewer where there are few files, see FilesFor; of the process's own.
constexpr double kFilesPart = 1.0 / 12;

constexpr unsigned int kTimeoutSeconds = 5;
constexpr size_t kMaxHeadBytes = 8192;

void Silent(void* /*self*/, const char* /*format*/, va_list /*arguments*/) {}

}  // namespace

struct MetricsHttp::Callbacks {
  static MHD_Result OnRequest(void* self, MHD_Connection* connection, const char* url,
                              const char* method, const char* /*version*/,
                              const char* /*upload_data*/, size_t* /*upload_bytes*/,
                              void** /*state*/) {
    // At once: a body that follows is not waited for.
    const Answer answer = static_cast<MetricsHttp*>(self)->AnswerTo(method, url);
    // The type of the parameter is not const, but the bytes are copied.
    MHD_Response* const response = MHD_create_response_from_buffer(
        answer.body.size(), const_cast<char*>(answer.body.data()), MHD_RESPMEM_MUST_COPY);
    if (response == nullptr) return MHD_NO;
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE,
                            "text/plain; version=0.0.4; charset=utf-8");
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONNECTION, "close");
    const MHD_Result queued = MHD_queue_response(connection, answer.status, response);
    MHD_destroy_response(response);
    return queued;
  }

  static void OnConnection(void* self, MHD_Connection* connection, void** handle,
                           MHD_ConnectionNotificationCode code) {
    auto* const http = static_cast<MetricsHttp*>(self);
    if (code == MHD_CONNECTION_NOTIFY_CLOSED) return http->OnClosed(*handle);
    const MHD_ConnectionInfo* const info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    *handle = http->OnOpened(info == nullptr ? -1 : info->connect_fd);
  }
};

absl::StatusOr<std::unique_ptr<MetricsHttp>> MetricsHttp::Start(const std::string& address,
                                                                Sources sources) {
  const absl::StatusOr<std::vector<int>> sockets = TcpListen(address);
  if (!sockets.ok()) {
    return absl::UnavailableError(absl::StrCat("metrics: ", sockets.status().message()));
  }
  // One is enough: the scraper is configured with the address.
  for (size_t i = 1; i < sockets->size(); ++i) close((*sockets)[i]);
  const int listener = sockets->front();
  std::unique_ptr<MetricsHttp> http(new MetricsHttp(std::move(sources)));
  http->port_ = PortOf(listener);
  http->daemon_ = MHD_start_daemon(
      MHD_USE_EPOLL_INTERNAL_THREAD, /*port=*/0, nullptr, nullptr, &Callbacks::OnRequest,
      http.get(), MHD_OPTION_EXTERNAL_LOGGER, &Silent, nullptr, MHD_OPTION_LISTEN_SOCKET, listener,
      MHD_OPTION_CONNECTION_LIMIT, kMaxConnections, MHD_OPTION_CONNECTION_TIMEOUT, kTimeoutSeconds,
      MHD_OPTION_CONNECTION_MEMORY_LIMIT, kMaxHeadBytes, MHD_OPTION_NOTIFY_CONNECTION,
      &Callbacks::OnConnection, http.get(), MHD_OPTION_END);
  if (http->daemon_ == nullptr) {
    close(listener);
    return absl::UnavailableError(absl::StrCat("metrics: cannot serve on ", address));
  }
  return http;
}

MetricsHttp::~MetricsHttp() {
  if (daemon_ != nullptr) MHD_stop_daemon(daemon_);
}

void* MetricsHttp::OnOpened(int fd) {
  connections_.emplace(++opened_, fd);
  // The library learns of the end of the connection, then closes the socket and calls OnClosed.
  if (static_cast<int>(connections_.size()) >
      PlacesFor(kFilesPart, /*files_each=*/1, kKeptConnections)) {
    const auto oldest = connections_.begin();
    shutdown(oldest->second, SHUT_RDWR);
    connections_.erase(oldest);
  }
  return reinterpret_cast<void*>(opened_);
}

MetricsHttp::Answer MetricsHttp::AnswerTo(const std::string& method,
                                          const std::string& path) const {
  if (method != MHD_HTTP_METHOD_GET && method != MHD_HTTP_METHOD_HEAD) {
    return {MHD_HTTP_METHOD_NOT_ALLOWED, ""};
  }
  if (path == "/metrics") return {MHD_HTTP_OK, sources_.metrics()};
  if (path == "/healthz") {
    return sources_.healthy() ? Answer{MHD_HTTP_OK, "ok\n"}
                              : Answer{MHD_HTTP_SERVICE_UNAVAILABLE, "a worker does not respond\n"};
  }
  if (path == "/readyz") {
    return sources_.ready() ? Answer{MHD_HTTP_OK, "ready\n"}
                            : Answer{MHD_HTTP_SERVICE_UNAVAILABLE, "draining\n"};
  }
  return {MHD_HTTP_NOT_FOUND, "use /metrics, /healthz or /readyz\n"};
}

}  // namespace traverse
