// Decides where `optimize` writes G-code, and in which container, and writes it.

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

// The flags about containers: --container, and those that ParsePlateOptions reads.
std::vector<Flag> ContainerFlagTable();
std::vector<Flag> PlateFlagTable();

// --plate and --ignore_md5.
absl::StatusOr<PlateOptions> ParsePlateOptions(const Flags& flags);

struct GcodeTarget {
  std::string name;  // empty: write none
  ContainerKind kind = ContainerKind::kText;
};

// The file for the rewritten G-code of `input`: -o; without it `input` itself, as slicers expect of
// post-processing scripts; for standard input standard output. None with --json but without -o,
// which asks for the routes alone. Its format is that of --container or of the extension of -o,
// otherwise the input's. An error if `input` would be replaced by a file of another format (also if
// it is compressed), or if it cannot be converted to the format.
absl::StatusOr<GcodeTarget> FindGcodeTarget(const Flags& flags, const InputFile& input);

// Writes `parts`: rewritten texts by their index in the container, if that is kept; otherwise one
// text with any index. Does not touch a file that would replace itself unless anything `changed`.
absl::Status WriteGcode(const InputFile& input, const std::map<size_t, NewPart>& parts,
                        bool changed, const GcodeTarget& target);

// The line with which `optimize` ends.
std::string GcodeSummary(const GcodeRewrite& rewrite);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_GCODE_OUTPUT_H_
