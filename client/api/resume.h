// The rest of a job whose call was lost, as jobs of their own.
//
// Layers are chained: each starts where the one before ended. So a resumed job begins at the end of
// the last layer that came back, and counts the layers since the last cleaning.

#ifndef TRAVERSE_CLIENT_API_RESUME_H_
#define TRAVERSE_CLIENT_API_RESUME_H_

#include <cstddef>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "absl/types/span.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/plan.pb.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {

// Layers [begin, end) of a job, all without an answer.
struct MissingRun {
  size_t begin = 0;
  size_t end = 0;
};

// The first run of layers that are not `answered`; empty if there is none.
MissingRun FirstMissing(const std::vector<bool>& answered);

// Whether the nozzle is cleaned after layer `index` of the job, if another layer follows.
bool CleaningDueAfter(const v1::JobOptions& options, size_t index);

// The options for a job of the layers from `begin` on, not counting those with a fault. `before` is
// the answer to the layer before it (null if begin is 0); `elapsed` is the time since the whole job
// began.
v1::JobOptions ResumedOptions(const v1::JobOptions& options, size_t begin,
                              const v1::LayerResult* before, absl::Duration elapsed);

// `message` with the position in a leading `layers[3]` shifted by `begin`.
std::string ShiftPlace(const std::string& message, size_t begin);

// The summary of a job that took several calls.
v1::JobSummary SummaryOf(const v1::JobOptions& options, absl::Span<const v1::LayerResult> layers,
                         const v1::JobSummary& last, double wall_seconds);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_RESUME_H_
