// From a sliced file to a job for the service.

#ifndef TRAVERSE_CLIENT_GCODE_GCODE_JOB_H_
#define TRAVERSE_CLIENT_GCODE_GCODE_JOB_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/gcode/gcode_options.h"
#include "client/gcode/measure/print_totals.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/placed_path.h"

namespace traverse {

struct InputJob;

namespace v1 {
class Layer;
class LayerResult;
}  // namespace v1

// The job in `file`: a plan for each of its layers, the cost of travel (a time) as the file's own
// moves show it, a strategy that searches short files for longer than long ones, and most of what
// `inspect` prints. Path i of layer l is block layers[l].first_block + i of the file. Labels count
// the paths of a layer from 1.
InputJob MakeGcodeJob(std::shared_ptr<const GcodeFile> file, const GcodeOptions& options);

// Adds facts that must be measured to a job from G-code: travel, retractions, visible walls
// crossed, print time; and what keeps paths in their places (barriers.h). Returns the totals of the
// print; Cancelled or DeadlineExceeded once options.limit ends.
absl::StatusOr<gcode::PrintTotals> AddMeasuredFacts(InputJob& job,
                                                    const GcodeOptions& options = {});

// The order of layer `layer` of `file` in an answer of the service. REQUIRES: the answer was
// checked against the layer of the job.
gcode::LayerOrder OrderOf(const GcodeFile& file, size_t layer, const v1::LayerResult& answer);

// ReadGcode and MakeGcodeJob. Cancelled or DeadlineExceeded once options.limit ends.
absl::StatusOr<InputJob> ReadGcodeJob(std::string text, const std::string& name,
                                      const GcodeOptions& options = {});

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_GCODE_JOB_H_
