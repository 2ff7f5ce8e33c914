#include "client/gateway/api/router.h"

#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/gateway/api/answers.h"
#include "client/gateway/api/counting.h"
#include "client/gateway/api/file_routes.h"
#include "client/gateway/api/job_routes.h"
#include "client/gateway/api/layer_routes.h"
#include "client/gateway/api/openapi.h"
#include "client/gateway/http/own_host.h"
#include "client/gateway/http/problem.h"
#include "client/gateway/octoprint/printer_api.h"
#include "client/gateway/page/page.h"

namespace traverse::gateway {
namespace {

HttpResponse Text(int status, const std::string& type, std::string text) {
  HttpResponse response;
  response.status = status;
  response.content_type = type;
  response.body = std::move(text);
  return response;
}

HttpResponse Page() {
  HttpResponse response = Text(200, "text/html; charset=utf-8", std::string(GatewayPage()));
  // The page and the report that it shows load nothing from outside.
  response.headers.emplace_back(
      "Content-Security-Policy",
      "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
      "img-src data: blob:; connect-src 'self'; frame-src blob:; base-uri 'none'; "
      "form-action 'none'; frame-ancestors 'none'");
  response.headers.emplace_back("Referrer-Policy", "no-referrer");
  return response;
}

// Whether another site's page makes the browser send this request: CORS is off.
bool IsForeign(const HttpRequest& request) {
  const std::string site = request.Header("sec-fetch-site");
  if (site == "cross-site" || site == "same-site") return true;
  const std::string origin = request.Header("origin");
  if (origin.empty()) return false;
  const size_t host = origin.find("://");
  return host == std::string::npos || origin.substr(host + 3) != request.Header("host");
}

// A page of another site that resolves its name to our address has no token or certificate.
bool IsForUs(const HttpRequest& request, const Core& core) {
  const std::vector<std::string>& allowed = core.options.allowed_hosts;
  const bool guarded = core.files.certificates != nullptr || !core.options.auth.token_file.empty();
  return (guarded && allowed.empty()) || IsOwnHost(request.Header("host"), allowed);
}

}  // namespace

absl::StatusOr<std::string> CallerOf(const HttpRequest& request, Authenticator& authenticator) {
  CallCredentials credentials;
  credentials.authorization = request.Header("authorization");
  const std::string key = request.Header("x-api-key");
  if (credentials.authorization.empty() && !key.empty()) {
    credentials.authorization = absl::StrCat("Bearer ", key);
  }
  credentials.identities = request.identities;
  credentials.host = request.peer_host;
  return authenticator.Identify(credentials);
}

HttpDecision Router::Handle(const HttpRequest& request) {
  std::string route = "other";
  HttpDecision decision = Open(request, route);
  return Counted(std::move(decision), route, core_.metrics);
}

HttpDecision Router::Open(const HttpRequest& request, std::string& route) {
  const std::string& path = request.path;
  if (path == "/" || path == "/openapi.json" || path == "/healthz" || path == "/readyz") {
    route = path;
    if (!IsGet(request)) return NotAllowed("GET");
    if (path == "/") return Page();
    if (path == "/openapi.json") return Text(200, "application/json", OpenApiJson());
    if (path == "/healthz") return Text(200, "text/plain", "ok\n");
    return core_.queue->draining() ? Text(503, "text/plain", "draining\n")
                                   : Text(200, "text/plain", "ready\n");
  }
  if (!IsForUs(request, core_)) {
    return Problem(421, "the request's Host is not a name of this gateway; see --allowed_hosts");
  }
  if (IsForeign(request)) {
    return Problem(403, "requests from pages of other sites are not allowed");
  }
  absl::StatusOr<std::string> caller = CallerOf(request, *core_.files.auth);
  if (!caller.ok()) return ProblemOf(caller.status());
  return ForCaller(request, *caller, route);
}

HttpDecision Router::ForCaller(const HttpRequest& request, const std::string& caller,
                               std::string& route) {
  const std::string& path = request.path;
  if (path == "/metrics") {
    route = path;
    if (!IsGet(request)) return NotAllowed("GET");
    return Text(200, "text/plain; version=0.0.4; charset=utf-8", core_.MetricsText());
  }
  if (path == "/v1/gcode" || path == "/v1/inspect" || path == "/v1/verify") {
    route = path;
    if (request.method != "POST") return NotAllowed("POST");
    if (path == "/v1/gcode") return RewriteRoute(request, caller, core_);
    if (path == "/v1/inspect") return InspectRoute(request, caller, core_);
    return VerifyRoute(request, caller, core_);
  }
  if (path == "/v1/optimize") {
    route = path;
    if (request.method != "POST") return NotAllowed("POST");
    return OptimizeRoute(request, caller, core_);
  }
  if (path == "/v1/strategies") {
    route = path;
    if (!IsGet(request)) return NotAllowed("GET");
    return StrategiesRoute(caller, core_);
  }
  if (IsJobPath(path)) return JobRoute(request, caller, core_, route);
  if (absl::StartsWith(path, "/api/") || absl::StartsWith(path, "/printers/")) {
    route = "printers";
    if (printers_ != nullptr) return printers_->Handle(request, caller);
    return Problem(404, "this gateway has no printers; see --printers");
  }
  return Problem(404, "there is nothing at this path; see /openapi.json");
}

}  // namespace traverse::gateway
