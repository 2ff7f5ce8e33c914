// From traverse.v1 to the engine: what a caller asked for.
//
// All functions are total: for any bytes that a caller managed to send, they return a value that
// the engine accepts, or a status that names the field at fault, such as
// `layers[3].islands[0].contours[1].points[7].x: not finite` or `options.cleaning.every_layers: 0
// is not at least 1`. Codes: InvalidArgument; Unimplemented for what only a later version knows (a
// strategy by name, or a field).

#ifndef TRAVERSE_SERVER_TRANSLATE_TRANSLATE_H_
#define TRAVERSE_SERVER_TRANSLATE_TRANSLATE_H_

#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "engine/engine.h"
#include "engine/strategy/strategy.h"
#include "server/jobs/job_run.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/plan.pb.h"

namespace traverse {

// A job without its layers.
struct JobSetup {
  std::string job_id;  // empty if the caller gave none
  std::string strategy_name;
  std::unique_ptr<Strategy> strategy;
  JobSpec spec;  // without the deadline
  bool interleaved = false;
  bool build_order = false;
  bool look_ahead = false;
  bool validate_only = false;
  bool partial_answers = false;
  double idle_speed_mm_s = 20.32;
  absl::Duration time_limit = absl::InfiniteDuration();
};

// Field names in errors begin with `options.`.
absl::StatusOr<JobSetup> JobFromProto(const v1::JobOptions& options);

// The layer at position `index` of its job. Like the functions below, asks `budget` regularly, if
// it is not null, but always finishes.
absl::StatusOr<LabelledLayer> LayerFromProto(const v1::Layer& layer, uint64_t index,
                                             bool interleaved, Budget* budget = nullptr);

// The number of points of a layer: of its contours and open paths together. O(paths).
int64_t CountPoints(const v1::Layer& layer, Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_TRANSLATE_TRANSLATE_H_
