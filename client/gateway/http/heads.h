// Converts heads of requests and responses from and to those of Boost.Beast.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_HEADS_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_HEADS_H_

#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/fields.hpp>
#include <boost/beast/http/parser.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "client/gateway/http/message.h"

namespace traverse::gateway {

// For a request whose body is read piece by piece.
class HeadParser : public boost::beast::http::request_parser<boost::beast::http::buffer_body> {
 public:
  // Whether a header goes on in another line, which HTTP/1.1 gave up: proxies read it otherwise.
  bool folded() const { return folded_; }

 private:
  void on_field_impl(boost::beast::http::field name, boost::beast::string_view name_text,
                     boost::beast::string_view value, boost::beast::error_code& error) override;

  bool folded_ = false;
};

// Whether the body comes plain or in chunks. Beast treats other codings as no body at all: the body
// would become the next request.
bool HasKnownCoding(const boost::beast::http::fields& head);

// The request whose head `parser` has read, without its sender; or why it is refused.
std::variant<HttpResponse, HttpRequest> RequestOf(const HeadParser& parser);

// Whether the body's bytes come plain, with their length stated.
bool IsPlain(const HeadParser& parser);

// Whether a body is complete of which `received` bytes have come.
bool AllCame(const HeadParser& parser, uint64_t received);

// The head of `response` as it is sent; `version` is 10 or 11. `size`: of the body; without it the
// body comes in chunks, or until the connection ends.
std::string HeadOf(const HttpResponse& response, unsigned version, bool keep,
                   std::optional<uint64_t> size);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_HEADS_H_
