// What the messages of GcodeService ask for.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_REWRITE_OPTIONS_H_
#define TRAVERSE_CLIENT_GATEWAY_API_REWRITE_OPTIONS_H_

#include <optional>

#include "absl/status/statusor.h"
#include "client/gateway/work/file_worker.h"
#include "client/gcode/verify/permissions.h"
#include "traverse/v1/gcode_service.pb.h"

namespace traverse::gateway {

// InvalidArgument that begins with the field at fault, as `options.last_layer: ...`. finish_by is
// left open.
absl::StatusOr<FileRequest> RequestOf(const v1::RewriteOptions& options);

// What may differ between two files. Nothing if the message leaves it to the file. Errors as above.
absl::StatusOr<std::optional<GivenPermissions>> PermissionsOf(const v1::VerifyOptions& options);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_REWRITE_OPTIONS_H_
