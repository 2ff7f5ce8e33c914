// What the service returned for one job.

#ifndef TRAVERSE_CLIENT_API_JOB_RESULT_H_
#define TRAVERSE_CLIENT_API_JOB_RESULT_H_

#include <vector>

#include "absl/status/status.h"
#include "traverse/v1/plan.pb.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {

// The answers for a whole job.
struct JobResult {
  // `layers[i]` answers layer i of the job; none is missing.
  std::vector<v1::LayerResult> layers;
  v1::JobSummary summary;
};

// OK if `result` visits each path of `layer` exactly once, at an entry that exists. Past this check
// you may index by the result. Otherwise Internal `visits[4]: ...`: the server is not ours.
absl::Status CheckVisits(const v1::Layer& layer, const v1::LayerResult& result);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_JOB_RESULT_H_
