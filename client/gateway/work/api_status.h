// The faults of files in the words of gcode_service.proto.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_API_STATUS_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_API_STATUS_H_

#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace traverse::gateway {

// What the API says of a `status` of FileWorker.
inline absl::Status ApiStatus(const absl::Status& status) {
  if (absl::IsDeadlineExceeded(status)) {
    return absl::FailedPreconditionError(
        absl::StrCat("nothing was found before the deadline: ", std::string(status.message())));
  }
  if (absl::IsUnimplemented(status)) return absl::InvalidArgumentError(status.message());
  return status;
}

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_API_STATUS_H_
