// Tolerances of comparisons, in one place.

#ifndef TRAVERSE_ENGINE_BASE_TOLERANCES_H_
#define TRAVERSE_ENGINE_BASE_TOLERANCES_H_

namespace traverse {

// Costs are as they are on ordinary parts: cost/cost_unit.h sees to that.

// A change of cost (mm or s) counts as a gain only below -kImprovementTolerance: a search that
// accepts rounding noise as progress can go round in circles.
inline constexpr double kImprovementTolerance = 1e-9;

// Two computations of one cost agree within kCostTolerance, relative to max(1, cost).
inline constexpr double kCostTolerance = 1e-6;

// Costs of two routes that differ by no more than this, relative to them, count as the same: in the
// chain of layers, whose costs are in the caller's unit.
inline constexpr double kSameCost = 1e-9;

// Largest coordinate, in mm. Squares and sums of such lengths keep their micrometres in a double.
inline constexpr double kMaxCoordinateMm = 1e6;

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_TOLERANCES_H_
