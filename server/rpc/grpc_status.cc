#include "server/rpc/grpc_status.h"

#include <string>

#include "absl/strings/cord.h"
#include "absl/strings/string_view.h"
#include "google/rpc/status.pb.h"
#include "server/translate/fault_list.h"

namespace traverse {
namespace {

// Trailers are limited to 8 KiB by default at the peers, percent encoding trebles a byte, and the
// details repeat the message. What a caller sent (a strategy's name) may be part of it.
constexpr size_t kMaxMessageBytes = 1024;

// `message` cut to the limit, not within a UTF-8 character.
std::string Bounded(std::string message) {
  if (message.size() <= kMaxMessageBytes) return message;
  size_t end = kMaxMessageBytes;
  while (end > 0 && (static_cast<unsigned char>(message[end]) & 0xc0u) == 0x80u) --end;
  message.resize(end);
  return message + "...";
}

}  // namespace

grpc::Status ToGrpcStatus(const absl::Status& plain) {
  if (plain.ok()) return grpc::Status::OK;
  const absl::Status status = WithDetails(plain);
  google::rpc::Status details;
  status.ForEachPayload([&details](absl::string_view type_url, const absl::Cord& value) {
    google::protobuf::Any& any = *details.add_details();
    any.set_type_url(std::string(type_url));
    any.set_value(std::string(value));
  });
  const std::string message = Bounded(std::string(status.message()));
  const auto code = static_cast<grpc::StatusCode>(status.code());
  if (details.details().empty()) return grpc::Status(code, message);
  details.set_code(code);
  details.set_message(message);
  return grpc::Status(code, message, details.SerializeAsString());
}

}  // namespace traverse
