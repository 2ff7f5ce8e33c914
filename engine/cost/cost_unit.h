// The unit in which costs are computed.
//
// A move may take a nanosecond or a century: the tolerances of searches and programmes
// (base/tolerances.h) are for costs as they are on ordinary parts. Problems whose costs are of
// another order are therefore solved in another unit. Units are powers of two, so that nothing is
// rounded: routes, and costs in the problem's own unit, are what they would be anyway.

#ifndef TRAVERSE_ENGINE_COST_COST_UNIT_H_
#define TRAVERSE_ENGINE_COST_COST_UNIT_H_

#include <initializer_list>

#include "engine/model/cost_spec.h"
#include "engine/model/layer_problem.h"

namespace traverse {

// By what to multiply the costs of some problems, for which `spec` holds: 1 if a move across all of
// them costs about as much as on ordinary parts. O(points).
double CostUnit(const CostSpec& spec, std::initializer_list<const LayerProblem*> problems);

// What costs `unit` times as much as by `spec`. REQUIRES: `unit` is of CostUnit(spec, ...).
CostSpec InUnit(const CostSpec& spec, double unit);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_COST_UNIT_H_
