// A lower bound by a linear programme, for layers of contours with few points.
//
// Trees let a route leave a contour at another point than it entered. The programme of path_tsp.h,
// with generalised subtours, hardly does. Given time it comes within 1 % and less, and within a few
// per cent in the time that a search takes.

#ifndef TRAVERSE_ENGINE_PROOF_BOUNDS_PROGRAMME_BOUND_H_
#define TRAVERSE_ENGINE_PROOF_BOUNDS_PROGRAMME_BOUND_H_

#include <optional>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"

namespace traverse {

// Unset for other layers (IsPortStage) and layers too large for the effort, or if the budget ends
// before there is a bound. At most `target`, the cost of a route. It ignores walls, which only add
// to costs. `effort` 1 takes some 100 ms, and time grows with the square root of the effort.
// Deterministic unless the budget ends it. REQUIRES: effort >= 0.
std::optional<double> ProgrammeBound(const LayerProblem& problem, double target, double effort,
                                     Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_BOUNDS_PROGRAMME_BOUND_H_
