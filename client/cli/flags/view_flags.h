// The flags for pictures: --picture with --layer, and --report.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_VIEW_FLAGS_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_VIEW_FLAGS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/flags/flags.h"
#include "client/cli/flags/job_flags.h"
#include "client/cli/outcome.h"

namespace traverse {

struct InputJob;

namespace report {
struct JobRun;
}

namespace view {
struct Scene;
}

namespace cli {

class Service;

struct ViewFlags {
  std::string picture;            // a file; empty: none
  std::string report;             // a file; empty: none
  std::optional<uint64_t> layer;  // of the picture: position in the file, from 1

  bool any() const { return !picture.empty() || !report.empty(); }
};

// The rows of these flags.
std::vector<Flag> ViewFlagTable();

// InvalidArgument, with the flag's name, for a name that does not show its format, and for a
// missing folder: before the work, not after it.
absl::StatusOr<ViewFlags> ParseViewFlags(const Flags& flags);

// InvalidArgument if --layer is not a layer of the job. Call it after --layers has selected
// them.
absl::Status CheckViewLayer(const ViewFlags& flags, const InputJob& job);

// Runs the job in the given order.
Expected<report::JobRun> RunAsGiven(Service& service, const JobFlags& flags, const InputJob& job);

// Writes what the flags request, each file whole or not at all.
absl::Status WriteViews(const ViewFlags& flags, const view::Scene& scene);

}  // namespace cli
}  // namespace traverse

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_VIEW_FLAGS_H_
