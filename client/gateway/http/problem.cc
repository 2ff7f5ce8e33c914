#include "client/gateway/http/problem.h"

#include <string_view>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/files/json.h"

namespace traverse::gateway {
namespace {

constexpr int kRetryAfterSeconds = 5;

JsonObject JsonOf(int status, const std::string& detail) {
  return {
      {"type", "about:blank"}, {"title", ReasonOf(status)}, {"status", status}, {"detail", detail}};
}

}  // namespace

std::string ReasonOf(int status) {
  static constexpr std::pair<int, std::string_view> kReasons[] = {
      {200, "OK"},
      {201, "Created"},
      {202, "Accepted"},
      {204, "No Content"},
      {304, "Not Modified"},
      {400, "Bad Request"},
      {401, "Unauthorized"},
      {403, "Forbidden"},
      {404, "Not Found"},
      {405, "Method Not Allowed"},
      {406, "Not Acceptable"},
      {408, "Request Timeout"},
      {409, "Conflict"},
      {410, "Gone"},
      {411, "Length Required"},
      {413, "Content Too Large"},
      {415, "Unsupported Media Type"},
      {421, "Misdirected Request"},
      {422, "Unprocessable Content"},
      {429, "Too Many Requests"},
      {431, "Request Header Fields Too Large"},
      {499, "Client Closed Request"},
      {500, "Internal Server Error"},
      {501, "Not Implemented"},
      {502, "Bad Gateway"},
      {503, "Service Unavailable"},
      {504, "Gateway Timeout"},
      {507, "Insufficient Storage"},
  };
  for (const auto& [known, reason] : kReasons) {
    if (known == status) return std::string(reason);
  }
  return absl::StrCat("Status ", status);
}

std::string ProblemJson(int status, const std::string& detail) {
  return JsonText(JsonOf(status, detail)) + "\n";
}

HttpResponse Problem(int status, const std::string& detail) {
  HttpResponse response;
  response.status = status;
  response.content_type = "application/problem+json";
  response.body = ProblemJson(status, detail);
  if (status == 401) response.headers.emplace_back("WWW-Authenticate", "Bearer");
  if (status == 503 || status == 429) {
    response.headers.emplace_back("Retry-After", std::to_string(kRetryAfterSeconds));
  }
  return response;
}

int HttpStatusOf(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kOk:
      return 200;
    case absl::StatusCode::kInvalidArgument:
      return 400;
    case absl::StatusCode::kUnauthenticated:
      return 401;
    case absl::StatusCode::kPermissionDenied:
      return 403;
    case absl::StatusCode::kNotFound:
      return 404;
    case absl::StatusCode::kOutOfRange:  // larger than a limit allows
      return 413;
    case absl::StatusCode::kUnimplemented:  // a file of another kind
      return 415;
    case absl::StatusCode::kFailedPrecondition:
      return 422;
    case absl::StatusCode::kCancelled:
      return 499;
    case absl::StatusCode::kResourceExhausted:
    case absl::StatusCode::kUnavailable:
      return 503;
    case absl::StatusCode::kDeadlineExceeded:
      return 504;
    default:
      return 500;
  }
}

HttpResponse Problem(int status, const std::string& detail, const ProblemDetails& details) {
  HttpResponse response = Problem(status, detail);
  Json json = JsonOf(status, detail);
  if (!details.code.empty()) json["code"] = details.code;
  JsonArray faults;
  for (const ProblemField& fault : details.faults) {
    faults.push_back(JsonObject{{"field", fault.field}, {"description", fault.description}});
  }
  if (!faults.empty()) json["details"] = std::move(faults);
  if (details.retry_after) {
    json["retry_after"] = *details.retry_after;
    std::erase_if(response.headers,
                  [](const auto& header) { return header.first == "Retry-After"; });
    response.headers.emplace_back("Retry-After", std::to_string(*details.retry_after));
  }
  response.body = JsonText(json) + "\n";
  return response;
}

HttpResponse ProblemOf(const absl::Status& status) {
  return Problem(HttpStatusOf(status.code()), std::string(status.message()));
}

}  // namespace traverse::gateway
