// Checks whether one file prints what another one prints, whatever containers they are in.

#ifndef TRAVERSE_CLIENT_CONTAINERS_VERIFY_FILES_H_
#define TRAVERSE_CLIENT_CONTAINERS_VERIFY_FILES_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/containers/container.h"
#include "client/gcode/verify/permissions.h"
#include "client/gcode/verify/report.h"
#include "client/gcode/work_limit.h"

namespace traverse {

struct VerifyFilesOptions {
  ContainerOptions container;
  std::optional<uint32_t> plate;  // unset: all of them

  // What may have changed. Unset: what the line at the head of each optimised text says, or safe.
  std::optional<GivenPermissions> permissions;

  gcode::WorkLimit limit = {};
};

// The findings of CheckGcode between each text of `optimised` and the text of the same plate of
// `original`, combined. Both are the bytes of files of any kind that OpenContainer accepts.
//
// Binary G-code keeps less than text: it drops spaces in moves and comments behind commands, and
// turns the comments of head and foot into metadata. If one of the two is binary, both are compared
// as a printer reads them, without these. If the optimised file says that it restated times, they
// are restated in the original first.
//
// Errors: those of OpenContainer; InvalidArgument if the files have different plates; Cancelled or
// DeadlineExceeded once options.limit ends.
absl::StatusOr<VerifyReport> VerifyFiles(std::string original, const std::string& original_name,
                                         std::string optimised, const std::string& optimised_name,
                                         const VerifyFilesOptions& options);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_CONTAINERS_VERIFY_FILES_H_
