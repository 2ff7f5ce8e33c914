// Heads of requests and responses, from those of Boost.Beast and back.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_HEADS_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_HEADS_H_

#include <boost/beast/http.hpp>
#include <cstdint>
#include <optional>
#include <variant>

#include "client/gateway/http/message.h"

namespace traverse::gateway {

// Of a request whose body is taken piece by piece.
using HeadParser = boost::beast::http::request_parser<boost::beast::http::buffer_body>;

// Whether the body comes as it is or in chunks. Beast takes other codings for none at all: the body
// would be the next request.
bool HasKnownCoding(const boost::beast::http::fields& head);

// The request whose head `parser` has read, but for who sent it; or why it is refused.
std::variant<HttpResponse, HttpRequest> RequestOf(const HeadParser& parser);

// Whether the body is so many bytes as they stand.
bool IsPlain(const HeadParser& parser);

// Whether there is nothing to come of a body of which so many bytes have.
bool AllCame(const HeadParser& parser, uint64_t received);

// The head of `response`; `version` is 10 or 11. `size` of the body; without it it comes in chunks,
// or until the connection ends.
boost::beast::http::response<boost::beast::http::empty_body> HeadOf(const HttpResponse& response,
                                                                    unsigned version, bool keep,
                                                                    std::optional<uint64_t> size);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_HEADS_H_
