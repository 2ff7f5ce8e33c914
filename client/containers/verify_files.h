// Does one file print what another one prints, whatever containers they are in?

#ifndef TRAVERSE_CLIENT_CONTAINERS_VERIFY_FILES_H_
#define TRAVERSE_CLIENT_CONTAINERS_VERIFY_FILES_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/containers/container.h"
#include "client/gcode/verify/verifier.h"

namespace traverse {

struct VerifyFilesOptions {
  ContainerOptions container;
  std::optional<uint32_t> plate;  // unset: all of them

  // What may have changed in one text, from that of the optimised file. Empty: what its line at the
  // head says, or safe.
  std::function<absl::StatusOr<VerifyOptions>(std::string_view optimised)> rules;
};

// What CheckGcode finds between each text of `optimised` and that of the same plate of `original`,
// put together. Both are the bytes of files of any kind that OpenContainer takes.
//
// Binary G-code keeps less than text does: spaces in moves, comments behind commands, and the
// comments of head and foot become metadata. If one of the two is binary, both are compared as a
// printer reads them, without these. Times that the optimised file says it
// restated are restated in the original first.
//
// The errors of OpenContainer and of `rules`; InvalidArgument if the files have not the same
// plates.
absl::StatusOr<VerifyReport> VerifyFiles(std::string original, const std::string& original_name,
                                         std::string optimised, const std::string& optimised_name,
                                         const VerifyFilesOptions& options);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_CONTAINERS_VERIFY_FILES_H_
