// The unit in which costs are computed.
//
// A move may take a nanosecond or a century, but the tolerances of searches and programmes
// (base/tolerances.h) suit costs of ordinary parts. So problems with costs of another magnitude are
// solved in another unit. Units are powers of two, so nothing is rounded: routes, and costs in the
// problem's own unit, do not change.

#ifndef TRAVERSE_ENGINE_COST_COST_UNIT_H_
#define TRAVERSE_ENGINE_COST_COST_UNIT_H_

#include "absl/types/span.h"
#include "engine/model/cost_spec.h"
#include "engine/model/layer_problem.h"

namespace traverse {

// The factor by which to multiply the costs of some problems that share `spec`: 1 if a move across
// all of them costs about as much as on ordinary parts. O(points).
double CostUnit(const CostSpec& spec, absl::Span<const LayerProblem* const> problems);

// The same costs as `spec`, multiplied by `unit`. REQUIRES: `unit` comes from CostUnit(spec, ...).
CostSpec InUnit(const CostSpec& spec, double unit);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_COST_UNIT_H_
