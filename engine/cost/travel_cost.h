// The cost of one travel move: its length, or its time.

#ifndef TRAVERSE_ENGINE_COST_TRAVEL_COST_H_
#define TRAVERSE_ENGINE_COST_TRAVEL_COST_H_

#include <cmath>

#include "engine/model/cost_spec.h"
#include "engine/model/point.h"

namespace traverse {

// A small value to pass by const reference into inner loops. The cost never falls as the length
// grows, so the nearest point is also the cheapest one to reach.
class TravelCost {
 public:
  explicit TravelCost(const CostSpec& spec)
      : spec_(spec),
        full_speed_mm_(spec.accel_mm_s2 > 0 ? spec.speed_mm_s * spec.speed_mm_s / spec.accel_mm_s2
                                            : 0) {}

  // In mm or s, as the spec says.
  double operator()(Point from, Point to) const { return OfLength(Distance(from, to)); }

  // Cost of a move of `length_mm` >= 0.
  double OfLength(double length_mm) const {
    return spec_.kind == CostSpec::Kind::kLength ? length_mm : Seconds(length_mm);
  }

  const CostSpec& spec() const { return spec_; }
  bool is_length() const { return spec_.kind == CostSpec::Kind::kLength; }

 private:
  // From standstill to standstill. With a = acceleration and v = speed, the speed is reached only
  // by moves longer than v^2 / a; these take l / v + v / a, shorter ones 2 sqrt(l / a).
  double Seconds(double length_mm) const {
    double seconds;
    if (length_mm >= full_speed_mm_) {
      seconds = length_mm / spec_.speed_mm_s;
      if (spec_.accel_mm_s2 > 0) seconds += spec_.speed_mm_s / spec_.accel_mm_s2;
    } else {
      seconds = 2 * std::sqrt(length_mm / spec_.accel_mm_s2);
    }
    return length_mm > spec_.retraction_threshold_mm ? seconds + spec_.retraction_seconds : seconds;
  }

  CostSpec spec_;
  double full_speed_mm_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_TRAVEL_COST_H_
