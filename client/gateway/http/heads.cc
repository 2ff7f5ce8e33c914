#include "client/gateway/http/heads.h"

#include <algorithm>
#include <string>
#include <utility>

#include "client/gateway/http/problem.h"
#include "client/gateway/http/target.h"

namespace traverse::gateway {

namespace beast = boost::beast;
namespace http = boost::beast::http;

bool HasKnownCoding(const http::fields& head) {
  const auto coding = head[http::field::transfer_encoding];
  return coding.empty() || beast::iequals(coding, "chunked");
}

std::variant<HttpResponse, HttpRequest> RequestOf(const HeadParser& parser) {
  HttpRequest request;
  const auto& head = parser.get();
  const auto text = [](beast::string_view view) { return std::string(view.data(), view.size()); };
  absl::StatusOr<Target> target = ParseTarget(text(head.target()));
  if (!target.ok()) return Problem(400, std::string(target.status().message()));
  if (!HasKnownCoding(head)) return Problem(501, "the only transfer encoding supported is chunked");
  request.method = text(head.method_string());
  request.path = std::move(target->path);
  request.query = std::move(target->query);
  for (const auto& field : head) {
    std::string name = text(field.name_string());
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
    request.headers.emplace_back(std::move(name), text(field.value()));
  }
  if (const auto length = parser.content_length()) request.content_length = *length;
  return request;
}

bool IsPlain(const HeadParser& parser) {
  return !parser.chunked() && parser.content_length().has_value();
}

bool AllCame(const HeadParser& parser, uint64_t received) {
  return parser.is_done() || (IsPlain(parser) && received == *parser.content_length());
}

http::response<http::empty_body> HeadOf(const HttpResponse& response, unsigned version, bool keep,
                                        std::optional<uint64_t> size) {
  http::response<http::empty_body> head;
  head.version(version);
  head.result(static_cast<unsigned>(response.status));
  head.reason(ReasonOf(response.status));
  if (!response.content_type.empty()) head.set(http::field::content_type, response.content_type);
  for (const auto& [name, value] : response.headers) head.set(name, value);
  head.set("X-Content-Type-Options", "nosniff");
  head.keep_alive(keep);
  if (size) {
    if (response.status != 204) head.content_length(*size);
  } else {
    head.chunked(version >= 11);
  }
  return head;
}

}  // namespace traverse::gateway
