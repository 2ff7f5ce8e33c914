#include "server/translate/translate_check.h"

#include "server/translate/fault_list.h"
#include "server/translate/field_ranges.h"

namespace traverse {

absl::Status CheckKnown(const google::protobuf::Message& message, const std::string& place) {
  const auto& unknown = message.GetReflection()->GetUnknownFields(message);
  if (unknown.empty()) return absl::OkStatus();
  return absl::UnimplementedError(absl::StrCat(place, ": field number ", unknown.field(0).number(),
                                               " is unknown to this version of the server"));
}

absl::StatusOr<Point> PointFromProto(const v1::Point& point, const std::string& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(point, place));
  TRAVERSE_RETURN_IF_ERROR(CheckRange(RangeOf("Point.x_mm"), point.x_mm(), place + ".x_mm"));
  TRAVERSE_RETURN_IF_ERROR(CheckRange(RangeOf("Point.y_mm"), point.y_mm(), place + ".y_mm"));
  return Point{point.x_mm(), point.y_mm()};
}

absl::StatusOr<CostSpec> CostFromProto(const v1::CostModel& cost, const std::string& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(cost, place));
  CostSpec spec;
  if (cost.has_length()) TRAVERSE_RETURN_IF_ERROR(CheckKnown(cost.length(), place + ".length"));
  if (!cost.has_time()) return spec;
  const v1::TimeCost& time = cost.time();
  const std::string at = place + ".time";
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(time, at));
  const auto check = [&](const char* field, double value) {
    return CheckRange(RangeOf(absl::StrCat("TimeCost.", field).c_str()), value,
                      absl::StrCat(at, ".", field));
  };
  FaultList faults;
  faults.Add(check("speed_mm_s", time.speed_mm_s()));
  faults.Add(check("accel_mm_s2", time.accel_mm_s2()));
  faults.Add(check("retraction_seconds", time.retraction_seconds()));
  faults.Add(check("retraction_threshold_mm", time.retraction_threshold_mm()));
  faults.Add(check("wall_retraction_threshold_mm", time.wall_retraction_threshold_mm()));
  faults.Add(check("exposed_retraction_threshold_mm", time.exposed_retraction_threshold_mm()));
  faults.Add(check("lift_seconds", time.lift_seconds()));
  faults.Add(check("crossing_seconds", time.crossing_seconds()));
  faults.Add(check("wall_slack_mm", time.wall_slack_mm()));
  faults.Add(check("wall_clearance_mm", time.wall_clearance_mm()));
  if (!faults.empty()) return faults.status();
  spec.kind = CostSpec::Kind::kTime;
  spec.speed_mm_s = time.speed_mm_s();
  spec.accel_mm_s2 = time.accel_mm_s2();
  spec.retraction_seconds = time.retraction_seconds();
  spec.retraction_threshold_mm = time.retraction_threshold_mm();
  spec.wall_retraction_threshold_mm = time.wall_retraction_threshold_mm();
  spec.exposed_retraction_threshold_mm = time.exposed_retraction_threshold_mm();
  spec.lift_seconds = time.lift_seconds();
  spec.crossing_seconds = time.crossing_seconds();
  if (time.has_wall_slack_mm()) spec.wall_slack_mm = time.wall_slack_mm();
  spec.wall_clearance_mm = time.wall_clearance_mm();
  return spec;
}

}  // namespace traverse
