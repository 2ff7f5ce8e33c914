// Requests and responses of HTTP, as handlers see them; only http_server knows the library that
// brings them.

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
  std::string path;  // without the query, with percent escapes decoded; checked by ParseTarget
  std::vector<std::pair<std::string, std::string>> query;    // decoded
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
  std::string content_type;  // empty: no body
  std::vector<std::pair<std::string, std::string>> headers;
  HttpBody body;

  // Of an answer that is written piece by piece: it tells of work that goes on without it, and can
  // be asked for again. Its connection may be closed to make room for others.
  bool only_watches = false;
};

// Sends the answer to a request. Thread-safe; all calls return at once. If the client has gone,
// they do nothing.
class HttpReply {
 public:
  virtual ~HttpReply() = default;

  // Sends the whole answer. Once, and not together with Begin.
  virtual void Send(HttpResponse response) = 0;

  // An answer whose body is written piece by piece: its head, the pieces, its end. An `optional`
  // piece is not taken (false) while the client is behind: a text for which there is no room in
  // memory, a file while anything waits.
  virtual void Begin(HttpResponse head) = 0;
  virtual bool Write(HttpBody piece, bool optional = false) = 0;
  virtual void End() = 0;

  // Calls `on_gone` once if the client leaves before it has the answer.
  virtual void OnGone(std::function<void()> on_gone) = 0;
};

// Receives the body of one request, on the thread of the connections: it must wait for nothing but
// the disk. Destroyed without Done if the upload breaks off.
class BodySink {
 public:
  virtual ~BodySink() = default;

  // Receives the next piece. A response ends the request, without the rest of the body.
  virtual std::optional<HttpResponse> Take(std::string_view piece) = 0;

  // The body is complete.
  virtual void Done(std::shared_ptr<HttpReply> reply) = 0;
};

// An immediate response, or the receiver of the body.
using HttpDecision = std::variant<HttpResponse, std::unique_ptr<BodySink>>;

// Decides when the head of a request has come, before its body is read.
using HttpHandler = std::function<HttpDecision(const HttpRequest& request)>;

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_MESSAGE_H_
