#include "engine/cost/cost_unit.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/cost/travel_cost.h"
#include "engine/geometry/bounding_box.h"

namespace traverse {
namespace {

// Costs need no other unit while the longest move costs between these: 13 cm or 0.13 s at least.
// Sums of the greatest costs are rounded by less than a hundredth of kImprovementTolerance.
constexpr double kLeastOrdinary = 0.125;
constexpr double kMostOrdinary = 32768;

// The cost that other longest moves are scaled to.
constexpr double kUsual = 128;

// Keeps speeds and accelerations far from the limits of a double. Points nearer to each other than
// a millionth of an atom are one point.
constexpr int kMostDoublings = 60;

}  // namespace

double CostUnit(const CostSpec& spec, absl::Span<const LayerProblem* const> problems) {
  BoundingBox box;
  for (const LayerProblem* problem : problems) {
    box.Add(problem->start);
    if (problem->finish) box.Add(*problem->finish);
    for (const Path& path : problem->plan->paths) box.Add(BoundingBox(path.points));
  }
  double longest = TravelCost(spec).OfLength(Distance(box.low(), box.high()));
  for (const LayerProblem* problem : problems) {
    if (problem->walls == nullptr) continue;
    longest += spec.retraction_seconds + spec.lift_seconds + spec.crossing_seconds;
    break;
  }
  if (longest == 0 || (longest >= kLeastOrdinary && longest <= kMostOrdinary)) return 1;
  const int doublings = static_cast<int>(std::floor(std::log2(kUsual / longest)));
  return std::ldexp(1, std::clamp(doublings, -kMostDoublings, kMostDoublings));
}

CostSpec InUnit(const CostSpec& spec, double unit) {
  assert(unit > 0);
  if (unit == 1) return spec;
  CostSpec scaled;
  scaled.kind = CostSpec::Kind::kTime;
  if (spec.kind == CostSpec::Kind::kLength) {
    // A length is the time at a speed of 1 mm per unit.
    scaled.speed_mm_s = 1 / unit;
    return scaled;
  }
  scaled = spec;  // lengths stay
  scaled.speed_mm_s /= unit;
  scaled.accel_mm_s2 /= unit * unit;
  scaled.retraction_seconds *= unit;
  scaled.lift_seconds *= unit;
  scaled.crossing_seconds *= unit;
  return scaled;
}

}  // namespace traverse
