// A connection as the server sees it.

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_ANY_SESSION_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_ANY_SESSION_H_

#include <chrono>
#include <optional>
#include <string>

namespace traverse::gateway {

// REQUIRES: all of it is used on the server's thread.
class AnySession {
 public:
  virtual ~AnySession() = default;

  // Ends it if it waits for a request; otherwise it ends after the current one.
  virtual void Drain() = 0;

  // Since when it waits for a request or for the rest of its head, or has sent nothing of an answer
  // for which nobody works any more. Nothing if its client's work would be lost with it.
  virtual std::optional<std::chrono::steady_clock::time_point> idle_since() const = 0;
  virtual const std::string& peer_host() const = 0;

  // Ends it at once.
  virtual void Close() = 0;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_ANY_SESSION_H_
