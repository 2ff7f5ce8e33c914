// The limits of a printer, as text that comes with a request.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_MACHINE_TEXT_H_
#define TRAVERSE_CLIENT_GATEWAY_API_MACHINE_TEXT_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/gateway/api/upload.h"
#include "client/gcode/machine/machine_limits.h"

namespace traverse::gateway {

inline constexpr size_t kMostMachineBytes = size_t{1} << 20;

// What `text` says: a Klipper configuration, or lines of Marlin. InvalidArgument that begins with
// `name` and the line, or says that there are more bytes than are taken.
absl::StatusOr<gcode::MachineLimits> ParseMachine(std::string_view text, const std::string& name);

// Takes the part `machine` of a form out of `upload`, and reads it. Nothing if there is none.
absl::StatusOr<std::optional<gcode::MachineLimits>> TakeMachine(Upload& upload);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_MACHINE_TEXT_H_
