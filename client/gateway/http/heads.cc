#include "client/gateway/http/heads.h"

#include <algorithm>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/write.hpp>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>

#include "client/gateway/http/problem.h"
#include "client/gateway/http/target.h"

namespace traverse::gateway {

namespace beast = boost::beast;
namespace http = boost::beast::http;

// Beast reads values where they came in, behind their names, and joins folded ones elsewhere.
void HeadParser::on_field_impl(http::field name, beast::string_view name_text,
                               beast::string_view value, beast::error_code& /*error*/) {
  constexpr std::uintptr_t kMostBlanks = 1024;
  const char* const behind = name_text.data() + name_text.size();
  const std::uintptr_t blanks =
      reinterpret_cast<std::uintptr_t>(value.data()) - reinterpret_cast<std::uintptr_t>(behind);
  folded_ |=
      !value.empty() && (blanks > kMostBlanks ||
                         std::string_view(behind, blanks).find('\n') != std::string_view::npos);
  get().insert(name, name_text, value);
}

namespace {

// What the head lacks or has too much of, if so.
const char* HeadProblem(const HeadParser& parser) {
  const auto& head = parser.get();
  if (parser.folded()) return "a header goes on in another line";
  const auto hosts = head.count(http::field::host);
  if (hosts > 1) return "there are two headers Host";
  if (hosts == 0 && head.version() >= 11) return "the header Host is missing";
  constexpr const char* kHostCharacters =
      "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz.-_~!$&'()*+,;=%:[]";
  if (head[http::field::host].find_first_not_of(kHostCharacters) != beast::string_view::npos) {
    return "the header Host is no name or address";
  }
  return nullptr;
}

}  // namespace

bool HasKnownCoding(const http::fields& head) {
  const auto coding = head[http::field::transfer_encoding];
  return coding.empty() || beast::iequals(coding, "chunked");
}

std::variant<HttpResponse, HttpRequest> RequestOf(const HeadParser& parser) {
  HttpRequest request;
  const auto& head = parser.get();
  const auto text = [](beast::string_view view) { return std::string(view.data(), view.size()); };
  std::string_view relative(head.target().data(), head.target().size());
  const std::string origin = TakeOrigin(relative);
  absl::StatusOr<Target> target = ParseTarget(relative);
  if (!target.ok()) return Problem(400, std::string(target.status().message()));
  if (const char* problem = HeadProblem(parser); problem != nullptr) return Problem(400, problem);
  if (!HasKnownCoding(head)) return Problem(501, "the only transfer encoding supported is chunked");
  request.method = text(head.method_string());
  request.path = std::move(target->path);
  request.query = std::move(target->query);
  for (const auto& field : head) {
    std::string name = text(field.name_string());
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
    const bool replaced = name == "host" && !origin.empty();
    request.headers.emplace_back(std::move(name), replaced ? origin : text(field.value()));
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

std::string HeadOf(const HttpResponse& response, unsigned version, bool keep,
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
  std::ostringstream text;
  text << head.base();
  return text.str();
}

}  // namespace traverse::gateway
