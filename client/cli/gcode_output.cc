#include "client/cli/gcode_output.h"

#include <fstream>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/files/decompress.h"
#include "client/files/write_file.h"
#include "client/gcode/gcode_file.h"
#include "client/gcode/parallel.h"

namespace traverse::cli {
namespace {

bool IsCompressed(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  std::string first(6, '\0');
  file.read(first.data(), static_cast<std::streamsize>(first.size()));
  first.resize(static_cast<size_t>(file.gcount()));
  return DetectCompression(first) != Compression::kNone;
}

}  // namespace

absl::StatusOr<std::string> GcodeTarget(const Flags& flags, const std::string& input) {
  if (flags.Has("o")) return flags.Text("o");
  if (flags.Has("json")) return std::string();
  if (input == "-") return input;
  if (IsCompressed(input)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s is compressed and the output is not: use -o OUTPUT", input));
  }
  return input;
}

absl::StatusOr<GcodeRewrite> RewriteByRuns(const InputJob& job,
                                           absl::Span<const report::JobRun* const> runs,
                                           const GcodeOptions& options) {
  std::vector<gcode::FileOrder> tries;
  for (const report::JobRun* run : runs) {
    gcode::FileOrder& orders = tries.emplace_back(job.gcode->layers.size());
    for (size_t i = 0; i < run->result.layers.size(); ++i) {
      const size_t layer = job.first_layer + i;
      orders[layer] = OrderOf(*job.gcode, layer, run->result.layers[i]);
    }
  }
  RewriteOptions rewrite;
  rewrite.policy = options.policy;
  rewrite.version = TRAVERSE_VERSION;
  rewrite.threads = gcode::ThreadsFor(job.gcode->text.size());
  return RewriteGcode(*job.gcode, tries, rewrite);
}

absl::Status WriteGcode(const GcodeRewrite& rewrite, const InputJob& job,
                        const std::string& target) {
  if (rewrite.layers_changed == 0 && target == job.name && target != "-") return absl::OkStatus();
  return WriteWholeFile(target, rewrite.text);
}

std::string GcodeSummary(const GcodeRewrite& rewrite) {
  if (rewrite.layers_changed == 0) {
    return absl::StrFormat("nothing to gain, the G-code stays as it is: %s\n",
                           DescribeRewrite(rewrite));
  }
  return absl::StrFormat("%d of %d layers rewritten: %s\n", rewrite.layers_changed, rewrite.layers,
                         DescribeRewrite(rewrite));
}

}  // namespace traverse::cli
