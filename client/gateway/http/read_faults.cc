#include "client/gateway/http/read_faults.h"

#include <boost/beast/http/error.hpp>

#include "absl/strings/str_cat.h"
#include "client/gateway/http/problem.h"

namespace traverse::gateway {
namespace {

namespace http = boost::beast::http;

// Whether the text is malformed, rather than cut off or the connection broken.
bool IsWrong(boost::system::error_code error) {
  return error.category() == http::make_error_code(http::error::bad_method).category() &&
         error != http::error::end_of_stream && error != http::error::partial_message;
}

}  // namespace

std::optional<HttpResponse> HeadFault(boost::system::error_code error, bool timed_out, bool begun) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return Problem(431, "the head of the request is too long");
  }
  if (timed_out && begun) return Problem(408, "the head of the request did not come in time");
  if (error == http::error::partial_message)
    return Problem(400, "the head of the request is cut short");
  if (!IsWrong(error)) return std::nullopt;
  return Problem(400, absl::StrCat("the request is not HTTP/1.1: ", error.message()));
}

HttpResponse BodyFault(boost::system::error_code error, bool timed_out, uint64_t received) {
  if (timed_out) {
    return Problem(408, absl::StrCat("the body came too slowly: ", received, " bytes so far"));
  }
  const char* what =
      IsWrong(error) ? "the body's chunks cannot be read after " : "the body was cut short after ";
  return Problem(400, absl::StrCat(what, received, " bytes"));
}

}  // namespace traverse::gateway
