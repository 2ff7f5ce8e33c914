#include "server/rpc/call_info.h"

#include <grpc/support/time.h>
#include <grpcpp/security/auth_context.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <climits>
#include <random>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_format.h"

namespace traverse {
namespace {

bool IsLowerHex(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }

// Whether text[begin, end) is hexadecimal and not all zeros.
bool IsId(const std::string& text, size_t begin, size_t end) {
  const auto first = text.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = text.begin() + static_cast<std::ptrdiff_t>(end);
  return std::all_of(first, last, IsLowerHex) &&
         std::any_of(first, last, [](char c) { return c != '0'; });
}

std::optional<Budget::Clock::time_point> Deadline(const grpc::CallbackServerContext& context,
                                                  Budget::Clock::time_point now) {
  const gpr_timespec raw = context.raw_deadline();
  if (gpr_time_cmp(raw, gpr_inf_future(raw.clock_type)) == 0) return std::nullopt;
  const gpr_timespec left = gpr_time_sub(raw, gpr_now(raw.clock_type));
  constexpr int64_t kMaxSeconds = int64_t{100} * 365 * 24 * 3600;  // keeps sums within the clock
  if (left.tv_sec > kMaxSeconds) return std::nullopt;
  return now + std::chrono::seconds(left.tv_sec) + std::chrono::nanoseconds(left.tv_nsec);
}

// The size that a caller declares; 0 if it is not a number, or larger than any message.
uint64_t MessageBytes(const grpc::string_ref& text) {
  uint64_t bytes = 0;
  const auto [end, error] = std::from_chars(text.begin(), text.end(), bytes);
  return error == std::errc() && end == text.end() && bytes <= INT_MAX ? bytes : 0;
}

}  // namespace

std::string PeerHost(const std::string& peer) {
  const bool has_port = peer.rfind("ipv4:", 0) == 0 || peer.rfind("ipv6:", 0) == 0;
  return has_port ? peer.substr(0, peer.rfind(':')) : peer;
}

std::string TraceId(const std::string& traceparent) {
  // version "-" trace id "-" parent id "-" flags: 2, 32, 16 and 2 digits.
  constexpr size_t kLength = 55, kTrace = 3, kParent = 36, kFlags = 53;
  if (traceparent.size() < kLength || traceparent[kTrace - 1] != '-' ||
      traceparent[kParent - 1] != '-' || traceparent[kFlags - 1] != '-' ||
      traceparent.compare(0, 2, "ff") == 0 || !IsLowerHex(traceparent[0]) ||
      !IsLowerHex(traceparent[1]) || !IsId(traceparent, kTrace, kParent - 1) ||
      !IsId(traceparent, kParent, kFlags - 1)) {
    return "";
  }
  return traceparent.substr(kTrace, kParent - 1 - kTrace);
}

absl::Status Authorize(const grpc::CallbackServerContext& context, Authenticator& authenticator,
                       CallInfo& info) {
  CallCredentials credentials;
  credentials.host = info.caller;
  const auto& metadata = context.client_metadata();
  const auto authorization = metadata.find("authorization");
  if (authorization != metadata.end()) {
    credentials.authorization.assign(authorization->second.data(), authorization->second.size());
  }
  const auto peer = context.auth_context();
  if (peer != nullptr && peer->IsPeerAuthenticated()) {
    for (const grpc::string_ref& identity : peer->GetPeerIdentity()) {
      credentials.identities.emplace_back(identity.data(), identity.size());
    }
  }
  absl::StatusOr<std::string> caller = authenticator.Identify(credentials);
  if (!caller.ok()) return caller.status();
  info.caller = *std::move(caller);
  return absl::OkStatus();
}

CallInfo ReadCallInfo(const grpc::CallbackServerContext& context, const std::string& method) {
  CallInfo info;
  info.start = Budget::Clock::now();
  info.method = method;
  info.peer = context.peer();
  info.caller = PeerHost(info.peer);
  info.deadline = Deadline(context, info.start);
  const auto& metadata = context.client_metadata();
  const auto trace = metadata.find("traceparent");
  if (trace != metadata.end()) {
    info.trace_id = TraceId(std::string(trace->second.data(), trace->second.size()));
  }
  const auto bytes = metadata.find(kMessageBytes);
  if (bytes != metadata.end()) info.message_bytes = MessageBytes(bytes->second);
  return info;
}

std::string NewJobId() {
  std::random_device random;
  return absl::StrFormat("%08x%08x", random(), random());
}

std::string MetadataText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (absl::ascii_isprint(static_cast<unsigned char>(c)) && c != '%' && c != ' ') {
      escaped.push_back(c);
    } else {
      escaped += absl::StrFormat("%%%02X", static_cast<unsigned char>(c));
    }
  }
  return escaped;
}

}  // namespace traverse
