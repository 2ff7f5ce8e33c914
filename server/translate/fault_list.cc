#include "server/translate/fault_list.h"

#include <algorithm>
#include <string>

#include "absl/strings/cord.h"
#include "google/rpc/error_details.pb.h"

namespace traverse {
namespace {

using google::rpc::BadRequest;

constexpr char kBadRequest[] = "type.googleapis.com/google.rpc.BadRequest";
constexpr char kErrorInfo[] = "type.googleapis.com/google.rpc.ErrorInfo";

// Peers limit trailers to 8 KiB by default, and binary content grows by a third.
constexpr size_t kMostBytes = 3000;
constexpr size_t kMostTextBytes = 200;

bool ContinuesCharacter(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }

// Where the field at fault ends in a message; npos if it names none. The name of an option, between
// [" and "], may have any characters.
size_t EndOfField(std::string_view message) {
  const size_t end = message.find(": ");
  const size_t name = message.find("[\"");
  if (name >= end) return end;
  const size_t end_of_name = message.find("\"]: ", name);
  return end_of_name == std::string_view::npos ? end : end_of_name + 2;
}

// The faults that a status carries; otherwise the one in its message, as `field: description`.
BadRequest FaultsOf(const absl::Status& status) {
  BadRequest faults;
  const absl::optional<absl::Cord> payload = status.GetPayload(kBadRequest);
  if (payload && faults.ParseFromString(std::string(*payload))) return faults;
  const std::string message(status.message());
  const size_t colon = EndOfField(message);
  BadRequest::FieldViolation& fault = *faults.add_field_violations();
  if (colon == std::string::npos) {
    fault.set_description(Beginning(message, kMostTextBytes));
  } else {
    fault.set_field(Beginning(message, std::min(colon, kMostTextBytes)));
    fault.set_description(Beginning(std::string_view(message).substr(colon + 2), kMostTextBytes));
  }
  return faults;
}

}  // namespace

std::string Beginning(std::string_view text, size_t most) {
  if (text.size() <= most) return std::string(text);
  while (most > 0 && ContinuesCharacter(text[most])) --most;
  return std::string(text.substr(0, most));
}

void FaultList::Add(const absl::Status& status) {
  if (status.ok() || full()) return;
  BadRequest all;
  if (status_.ok()) {
    status_ = absl::Status(status.code(), status.message());
  } else {
    all = FaultsOf(status_);
  }
  const BadRequest more = FaultsOf(status);
  for (const BadRequest::FieldViolation& fault : more.field_violations()) {
    if (all.field_violations_size() == kMost || all.ByteSizeLong() > kMostBytes) break;
    *all.add_field_violations() = fault;
  }
  count_ = all.ByteSizeLong() > kMostBytes ? kMost : all.field_violations_size();
  status_.SetPayload(kBadRequest, absl::Cord(all.SerializeAsString()));
}

absl::Status WithDetails(absl::Status status) {
  if (!FaultList::IsFault(status)) return status;
  status.SetPayload(kBadRequest, absl::Cord(FaultsOf(status).SerializeAsString()));
  google::rpc::ErrorInfo info;
  info.set_reason(absl::IsUnimplemented(status) ? "NOT_KNOWN_TO_THIS_VERSION" : "FIELD_AT_FAULT");
  info.set_domain("traverse.v1");
  status.SetPayload(kErrorInfo, absl::Cord(info.SerializeAsString()));
  return status;
}

}  // namespace traverse
