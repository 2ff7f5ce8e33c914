// What a call brings besides its messages: who, from where, until when, as part of what.

#ifndef TRAVERSE_SERVER_RPC_CALL_INFO_H_
#define TRAVERSE_SERVER_RPC_CALL_INFO_H_

#include <grpcpp/server_context.h>

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "engine/base/budget.h"
#include "server/access/auth.h"

namespace traverse {

// The metadata in which a caller may declare the size of the message that follows, so that a job
// that is too large is refused before it is sent.
constexpr char kMessageBytes[] = "traverse-message-bytes";

struct CallInfo {
  std::string method;          // without the service's name
  std::string peer;            // address with port, as gRPC writes it
  std::string caller;          // who it is counted for; until Authorize the peer without its port
  std::string trace_id;        // 32 hexadecimal digits of a valid traceparent, or empty
  uint64_t message_bytes = 0;  // of the first message, as stated in kMessageBytes; 0: not stated
  Budget::Clock::time_point start;
  std::optional<Budget::Clock::time_point> deadline;
};

// Reads the call's context. The deadline is counted from now on the steady clock, so that setting
// the machine's clock does not move it.
CallInfo ReadCallInfo(const grpc::CallbackServerContext& context, const std::string& method);

// Sets `info.caller` to what `authenticator` says. Errors: Unauthenticated, PermissionDenied.
absl::Status Authorize(const grpc::CallbackServerContext& context, Authenticator& authenticator,
                       CallInfo& info);

// `peer` without its port: "ipv4:10.0.0.7:41234" -> "ipv4:10.0.0.7".
std::string PeerHost(const std::string& peer);

// The trace id of a W3C `traceparent` header, or empty if it is not valid.
std::string TraceId(const std::string& traceparent);

// An id for a job whose caller gave none: 16 random hexadecimal digits.
std::string NewJobId();

// `text` in a form allowed in metadata: other than printable ASCII is escaped as in a URL.
std::string MetadataText(const std::string& text);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_CALL_INFO_H_
