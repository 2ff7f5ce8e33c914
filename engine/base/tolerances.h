// Tolerances of comparisons, in one place.

#ifndef TRAVERSE_ENGINE_BASE_TOLERANCES_H_
#define TRAVERSE_ENGINE_BASE_TOLERANCES_H_

namespace traverse {

// Costs have the magnitude that they have on ordinary parts; cost/cost_unit.h ensures that.

// A change of cost (mm or s) counts as a gain only below -kImprovementTolerance. A search that
// takes rounding noise for progress can go round in circles.
inline constexpr double kImprovementTolerance = 1e-9;

// Two computations of the same cost agree within kCostTolerance, relative to max(1, cost).
inline constexpr double kCostTolerance = 1e-6;

// Two routes count as equally expensive if their costs differ by no more than this, relatively. For
// the chain of layers, whose costs are in the caller's unit.
inline constexpr double kSameCost = 1e-9;

// Largest coordinate, in mm. A double keeps micrometres in squares and sums of such lengths.
inline constexpr double kMaxCoordinateMm = 1e6;

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_TOLERANCES_H_
