// The cost of one travel move: its length, or its time.

#ifndef TRAVERSE_ENGINE_COST_TRAVEL_COST_H_
#define TRAVERSE_ENGINE_COST_TRAVEL_COST_H_

#include <algorithm>
#include <cmath>
#include <concepts>

#include "engine/model/cost_spec.h"
#include "engine/model/layer_problem.h"
#include "engine/model/point.h"

namespace traverse {

// A small value to pass by const reference into inner loops. Without walls the cost never falls as
// the length grows, so the nearest point is also the cheapest to reach. Walls only add to the cost
// of the length, so that bounds the cost from below.
class TravelCost {
 public:
  // `walls` must outlive this object and are multiplied by `walls_unit`; null: there are none.
  explicit TravelCost(const CostSpec& spec, const WallCost* walls = nullptr, double walls_unit = 1)
      : spec_(spec),
        walls_(walls),
        walls_unit_(walls_unit),
        ramp_seconds_(spec.accel_mm_s2 > 0 ? spec.speed_mm_s / spec.accel_mm_s2 : 0),
        full_speed_mm_(spec.speed_mm_s * ramp_seconds_),
        threshold_seconds_(Motion(spec.retraction_threshold_mm)) {}

  // A template, so that {} is not taken for a LayerProblem.
  template <std::same_as<LayerProblem> Problem>
  explicit TravelCost(const Problem& problem)
      : TravelCost(problem.cost, problem.walls, problem.walls_unit) {}

  // In mm or s, as the spec says. The same in both directions.
  double operator()(Point from, Point to) const {
    return walls_ == nullptr ? Base(from, to) : WithWalls(from, to);
  }

  // A lower bound of the move's cost: its cost without walls.
  double Base(Point from, Point to) const { return OfLength(Distance(from, to)); }

  // Cost of a move of `length_mm` >= 0 that no wall affects.
  double OfLength(double length_mm) const {
    return spec_.kind == CostSpec::Kind::kLength ? length_mm : Seconds(length_mm);
  }

  // Seconds of a move of `length_mm` >= 0 without a retraction, if the cost is a time. From
  // standstill to standstill, with a = acceleration and v = speed: only moves longer than v^2 / a
  // reach the speed and take l / v + v / a; shorter ones take 2 sqrt(l / a).
  double Motion(double length_mm) const {
    if (length_mm >= full_speed_mm_) return length_mm / spec_.speed_mm_s + ramp_seconds_;
    return 2 * std::sqrt(length_mm / spec_.accel_mm_s2);
  }

  // The length in mm of the longest moves that cost no more than `cost` >= 0, apart from rounding.
  // For quick rejections: whatever is farther away costs more.
  double LongestWithin(double cost) const {
    if (is_length()) return cost;
    // Just above the threshold, moves cost a whole retraction more.
    const bool may_retract = cost > threshold_seconds_ + spec_.retraction_seconds;
    const double seconds =
        may_retract ? cost - spec_.retraction_seconds : std::min(cost, threshold_seconds_);
    if (seconds >= 2 * ramp_seconds_) return (seconds - ramp_seconds_) * spec_.speed_mm_s;
    return spec_.accel_mm_s2 * seconds * seconds / 4;
  }

  const CostSpec& spec() const { return spec_; }
  bool is_length() const { return spec_.kind == CostSpec::Kind::kLength; }
  bool has_walls() const { return walls_ != nullptr; }

 private:
  double Seconds(double length_mm) const {
    const double seconds = Motion(length_mm);
    return length_mm > spec_.retraction_threshold_mm ? seconds + spec_.retraction_seconds : seconds;
  }

  double WithWalls(Point from, Point to) const;

  CostSpec spec_;
  const WallCost* walls_;
  double walls_unit_;
  double ramp_seconds_;       // v / a
  double full_speed_mm_;      // v^2 / a
  double threshold_seconds_;  // motion of a move with the length of the retraction threshold
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_TRAVEL_COST_H_
