// Where the G-code that `optimize` writes goes, in which container, and writing it.

#ifndef TRAVERSE_CLIENT_CLI_GCODE_OUTPUT_H_
#define TRAVERSE_CLIENT_CLI_GCODE_OUTPUT_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/flags/flags.h"
#include "client/containers/container.h"
#include "client/formats/read_input.h"
#include "client/gcode/rewrite.h"
#include "client/optimize_file/optimize_file.h"

namespace traverse::cli {

// The rows of the flags about containers: --container, and those that ParsePlateOptions reads.
std::vector<Flag> ContainerFlagTable();
std::vector<Flag> PlateFlagTable();

// --plate and --ignore_md5.
absl::StatusOr<PlateOptions> ParsePlateOptions(const Flags& flags);

struct GcodeTarget {
  std::string name;  // empty: none is written
  ContainerKind kind = ContainerKind::kText;
};

// The file that gets the rewritten G-code of `input`: -o; without it `input` itself, as slicers
// call post-processing scripts, and for standard input standard output. None if none is to be
// written: --json without -o asks for the routes alone. It is a container of the kind that
// --container or the extension of -o says, and else of the input's. A fault if `input` would be
// replaced by another kind of file (compressed input too), or if that kind cannot be made of it.
absl::StatusOr<GcodeTarget> FindGcodeTarget(const Flags& flags, const InputFile& input);

// Writes `parts`: rewritten texts by index of the container, where that is kept, and else the one
// text by any index. Unless anything `changed`, a file that would replace itself is not touched.
absl::Status WriteGcode(const InputFile& input, const std::map<size_t, NewPart>& parts,
                        bool changed, const GcodeTarget& target);

// The line with which `optimize` ends.
std::string GcodeSummary(const GcodeRewrite& rewrite);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_GCODE_OUTPUT_H_
