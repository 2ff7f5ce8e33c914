#include "server/translate/field_ranges.h"

#include <algorithm>
#include <cassert>
#include <climits>
#include <cmath>
#include <cstring>

#include "absl/strings/str_format.h"
#include "engine/base/tolerances.h"
#include "server/translate/translate_check.h"

namespace traverse {
namespace {

constexpr double kMostSeconds = 315'576'000'000;  // of google.protobuf.Duration
constexpr double kNanosecond = 1e-9;

// The ranges go far beyond any machine, but not so far that times lose their meaning. Fields that
// are not here are labels or seeds, for which any value will do.
constexpr FieldRange kRanges[] = {
    {"Point.x_mm", -kMaxCoordinateMm, kMaxCoordinateMm},
    {"Point.y_mm", -kMaxCoordinateMm, kMaxCoordinateMm},
    {"Cleaning.every_layers", 1, INT_MAX},
    {"Cleaning.layers_since_cleaning", 0, INT_MAX - 1},
    {"TimeCost.speed_mm_s", 1e-3, 1e5},
    {"TimeCost.accel_mm_s2", 1e-3, 1e7, /*or_zero=*/true},
    {"TimeCost.retraction_seconds", 0, 1e4},
    {"TimeCost.retraction_threshold_mm", 0, 1e7},
    {"TimeCost.wall_retraction_threshold_mm", 0, 1e7},
    {"TimeCost.exposed_retraction_threshold_mm", 0, 1e7},
    {"TimeCost.lift_seconds", 0, 1e4},
    {"TimeCost.crossing_seconds", 0, 1e4},
    {"TimeCost.wall_slack_mm", 0, 1e3},
    {"TimeCost.wall_clearance_mm", 1e-3, 1e3, /*or_zero=*/true},
    {"Wall.points", -kMaxCoordinateMm, kMaxCoordinateMm},
    {"Wall.path", 0, INT_MAX},
    {"Layer.exposed_paths", 0, INT_MAX},
    {"Layer.retracted_paths", 0, INT_MAX},
    {"Departure.open_seconds", 0, 1e4},
    {"Departure.retracted_seconds", 0, 1e4},
    {"Arrival.open_seconds", 0, 1e4},
    {"Arrival.retracted_seconds", 0, 1e4},
    {"KnownMove.from", 0, INT_MAX},
    {"KnownMove.to", 0, INT_MAX},
    {"KnownMove.seconds", 0, 1e7},
    {"JobOptions.idle_speed_mm_s", 1e-3, 1e5},
    {"JobOptions.time_limit", kNanosecond, kMostSeconds},
    {"JobOptions.layer_time_limit", kNanosecond, kMostSeconds},
    {"Contour.points", -kMaxCoordinateMm, kMaxCoordinateMm},
    {"Contour.entries", 0, INT_MAX},
    {"OpenPath.points", -kMaxCoordinateMm, kMaxCoordinateMm},
    {"InOrder.children", 0, INT_MAX},
    {"AnyOrder.children", 0, INT_MAX},
    {"Precedence.first", 0, INT_MAX},
    {"Precedence.second", 0, INT_MAX},
    {"PlanNode.path", 0, INT_MAX},
    {"Layer.z_mm", -kMaxCoordinateMm, kMaxCoordinateMm},
};

}  // namespace

absl::Span<const FieldRange> FieldRanges() { return kRanges; }

const FieldRange& RangeOf(const char* field) {
  const auto* const range =
      std::find_if(std::begin(kRanges), std::end(kRanges),
                   [&](const FieldRange& row) { return std::strcmp(row.field, field) == 0; });
  assert(range != std::end(kRanges));
  return *range;
}

absl::Status CheckRange(const FieldRange& range, double value, const std::string& place) {
  if (!std::isfinite(value)) return Fault(place, "not finite");
  if (value >= range.least && value <= range.greatest) return absl::OkStatus();
  if (range.or_zero && value == 0) return absl::OkStatus();
  return Fault(place, absl::StrFormat("%g is not %sfrom %.12g to %.12g", value,
                                      range.or_zero ? "0 or " : "", range.least, range.greatest));
}

}  // namespace traverse
