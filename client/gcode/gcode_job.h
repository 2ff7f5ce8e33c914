// From a sliced file to a job for the service.

#ifndef TRAVERSE_CLIENT_GCODE_GCODE_JOB_H_
#define TRAVERSE_CLIENT_GCODE_GCODE_JOB_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "client/gcode/machine/machine_limits.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/plan/policy.h"
#include "client/gcode/write/layer_writer.h"
#include "client/input/input_job.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {

struct GcodeOptions {
  static constexpr double kMostRevisitSeconds = 3600;

  gcode::Policy policy = gcode::Policy::kSafe;
  gcode::Crossings crossings = gcode::Crossings::kKeep;
  gcode::Allowance allow = {};
  double min_revisit_seconds = 0;  // see RewriteOptions

  // What counts in place of what files state of their machine.
  std::optional<gcode::MachineLimits> machine = {};
};

// The job in `file`: a plan for each of its layers, the cost of travel as its own moves show it
// (time), a strategy that searches short files for longer than long ones, and most of what
// `inspect` prints. Path i of layer l is block layers[l].first_block + i of the file; labels count
// the paths of a layer from 1.
InputJob MakeGcodeJob(std::shared_ptr<const GcodeFile> file, const GcodeOptions& options);

// Adds to the facts of a job from G-code what has to be measured for them: way, retractions,
// visible walls crossed, print time.
void AddMeasuredFacts(InputJob& job);

// The layers of `job`, which is one of G-code, with plans of less latitude: a second way to look
// for an order (policy.h). Crossings cost more where `found` has more of them than given, or is not
// there, unless any are allowed; else, where it is longer, which Policy::kSafe does not allow, they
// cost nothing, nor do retractions, but in files whose ways lead around walls.
std::vector<v1::Layer> NarrowLayers(const InputJob& job, const GcodeOptions& options,
                                    absl::Span<const v1::LayerResult> found = {});

// The order that an answer of the service gives layer `layer` of `file`.
// REQUIRES: the answer was checked against the layer of the job.
gcode::LayerOrder OrderOf(const GcodeFile& file, size_t layer, const v1::LayerResult& answer);

// ReadGcode and MakeGcodeJob.
absl::StatusOr<InputJob> ReadGcodeJob(std::string text, const std::string& name,
                                      const GcodeOptions& options = {});

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_GCODE_JOB_H_
