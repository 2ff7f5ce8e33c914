// Requests and responses of HTTP, as handlers see them; which library brings them is http_server's
// own affair.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_MESSAGE_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_MESSAGE_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "client/gateway/spool/spool.h"

namespace traverse::gateway {

// The head of a request.
struct HttpRequest {
  std::string method;
  std::string path;  // without the query; percent escapes undone, checked by ParseTarget
  std::vector<std::pair<std::string, std::string>> query;    // escapes undone
  std::vector<std::pair<std::string, std::string>> headers;  // names in small letters
  std::string peer_host;                                     // "ipv4:10.0.0.7", as gRPC writes it
  std::vector<std::string> identities;                       // of a verified client certificate
  std::optional<uint64_t> content_length;

  // The first header of this name, in small letters; empty if there is none.
  std::string Header(std::string_view name) const;
};

// A body: text, or a file of the spool from its beginning.
using HttpBody = std::variant<std::string, std::shared_ptr<const SpoolFile>>;

struct HttpResponse {
  int status = 200;
  std::string content_type;  // empty: no body is expected
  std::vector<std::pair<std::string, std::string>> headers;
  HttpBody body;
};

// The way back to who sent a request. Thread-safe; all calls return at once. If the client has
// gone, they do nothing.
class HttpReply {
 public:
  virtual ~HttpReply() = default;

  // The whole answer. Once, and not beside Begin.
  virtual void Send(HttpResponse response) = 0;

  // An answer whose body is written piece by piece: its head; pieces; its end. A piece for which
  // there is no room is dropped if it is `optional`: progress that nobody reads.
  virtual void Begin(HttpResponse head) = 0;
  virtual void Write(HttpBody piece, bool optional = false) = 0;
  virtual void End() = 0;

  // `on_gone` is called, once, if the client goes before it has the answer.
  virtual void OnGone(std::function<void()> on_gone) = 0;
};

// Takes the body of one request. Called by the thread of the connections: it must not wait for
// anything but the disk. Destroyed without Done if the upload breaks off.
class BodySink {
 public:
  virtual ~BodySink() = default;

  // The next piece. A response ends the request: the rest of the body is not wanted.
  virtual std::optional<HttpResponse> Take(std::string_view piece) = 0;

  // The body is complete.
  virtual void Done(std::shared_ptr<HttpReply> reply) = 0;
};

// A response at once, or who takes the body.
using HttpDecision = std::variant<HttpResponse, std::unique_ptr<BodySink>>;

// Decides when the head of a request is there, before any of its body is read.
using HttpHandler = std::function<HttpDecision(const HttpRequest& request)>;

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_MESSAGE_H_
