// Where the G-code that `optimize` writes goes, and writing it.

#ifndef TRAVERSE_CLIENT_CLI_GCODE_OUTPUT_H_
#define TRAVERSE_CLIENT_CLI_GCODE_OUTPUT_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "client/cli/flags.h"
#include "client/cli/job_flags.h"
#include "client/gcode/rewrite.h"
#include "client/input/input_job.h"
#include "client/report/run.h"

namespace traverse::cli {

// The file that gets the rewritten G-code of `input`: -o; without it `input` itself, as slicers
// call post-processing scripts, and for standard input standard output. Empty if none is to be
// written: --json without -o asks for the routes alone. A fault if `input` is compressed and would
// be replaced, for what is written is not.
absl::StatusOr<std::string> GcodeTarget(const Flags& flags, const std::string& input);

// Rewrites the file of `job` by the best of what `runs` have for each layer. They answer the layers
// that --layers left in `job`; the others stay as they are.
absl::StatusOr<GcodeRewrite> RewriteByRuns(const InputJob& job,
                                           absl::Span<const report::JobRun* const> runs,
                                           const GcodeOptions& options);

// Writes `rewrite`. A file that would replace itself by the same bytes is not touched.
absl::Status WriteGcode(const GcodeRewrite& rewrite, const InputJob& job,
                        const std::string& target);

// The line with which `optimize` ends.
std::string GcodeSummary(const GcodeRewrite& rewrite);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_GCODE_OUTPUT_H_
