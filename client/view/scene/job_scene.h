// Scenes of jobs and the routes that the service found for them.

#ifndef TRAVERSE_CLIENT_VIEW_SCENE_JOB_SCENE_H_
#define TRAVERSE_CLIENT_VIEW_SCENE_JOB_SCENE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/gcode/rewrite.h"
#include "client/input/input_job.h"
#include "client/report/run.h"
#include "client/view/scene/scene.h"

namespace traverse::view {

// A run of the job, and its name.
struct NamedRun {
  std::string label;
  const report::JobRun* run = nullptr;
};

// The job with the routes of `runs`, with straight moves, as the service counts them. `given` is a
// run of the strategy none. Job and runs must outlive the scene. REQUIRES: every run passed
// CheckVisits.
Scene JobScene(const InputJob& job, const report::JobRun& given, const std::vector<NamedRun>& runs);

// G-code before and after: travel, retractions and time of both files, with the actual moves of the
// head in each. `rewrite` is what RewriteGcode made of the job with the orders of `run`. The job
// must outlive the scene. Errors are those of reading the new text.
absl::StatusOr<Scene> GcodeScene(const InputJob& job, const std::string& label,
                                 const report::JobRun& run, const GcodeRewrite& rewrite);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_SCENE_JOB_SCENE_H_
