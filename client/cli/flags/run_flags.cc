#include "client/cli/flags/run_flags.h"

#include <utility>

namespace traverse::cli {

std::vector<Flag> WithRunFlagTable(std::vector<Flag> own) {
  own.push_back({"json", "FILE", "write the routes; - is standard output"});
  return Joined(Joined(Joined(std::move(own), ViewFlagTable()), JobFlagTable()),
                ServiceFlagTable());
}

absl::StatusOr<RunFlags> ParseRunFlags(const Flags& flags) {
  RunFlags out;
  auto job = ParseJobFlags(flags);
  if (!job.ok()) return job.status();
  out.job = *std::move(job);
  auto views = ParseViewFlags(flags);
  if (!views.ok()) return views.status();
  out.views = *std::move(views);
  out.json = flags.Text("json");
  out.quiet = flags.Switch("quiet");
  return out;
}

}  // namespace traverse::cli
