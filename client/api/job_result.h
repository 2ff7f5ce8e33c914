// What the service made of one job.

#ifndef TRAVERSE_CLIENT_API_JOB_RESULT_H_
#define TRAVERSE_CLIENT_API_JOB_RESULT_H_

#include <vector>

#include "absl/status/status.h"
#include "traverse/v1/plan.pb.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {

// A whole job's answers.
struct JobResult {
  // `layers[i]` answers layer i of the job; all are there.
  std::vector<v1::LayerResult> layers;
  v1::JobSummary summary;
};

// OK if `result` visits each path of `layer` exactly once, at an entry that exists: past this check
// whoever uses a result may index by it. Internal `visits[4]: ...` if not: the server is not ours.
absl::Status CheckVisits(const v1::Layer& layer, const v1::LayerResult& result);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_API_JOB_RESULT_H_
