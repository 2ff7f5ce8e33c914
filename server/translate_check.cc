#include "server/translate_check.h"

#include "engine/model/plan.h"

namespace traverse {
namespace {

// Bounds of the machine's figures; far beyond any machine, and small enough to keep times finite.
constexpr double kMaxSpeed = 1e5;
constexpr double kMaxAcceleration = 1e7;
constexpr double kMaxRetractionSeconds = 1e4;
constexpr double kMaxThresholdMm = 1e7;

absl::Status CheckRange(double value, double maximum, const std::string& place) {
  if (!std::isfinite(value)) return Fault(place, "not finite");
  if (value < 0) return Fault(place, absl::StrCat(value, " is below 0"));
  if (value > maximum) return Fault(place, absl::StrCat(value, " is above ", maximum));
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckKnown(const google::protobuf::Message& message, const std::string& place) {
  const auto& unknown = message.GetReflection()->GetUnknownFields(message);
  if (unknown.empty()) return absl::OkStatus();
  return absl::UnimplementedError(absl::StrCat(place, ": field number ", unknown.field(0).number(),
                                               " is not known to this version of the server"));
}

absl::StatusOr<Point> PointFromProto(const v1::Point& point, const std::string& place) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(point, place));
  if (const char* fault = CoordinateFault(point.x_mm())) return Fault(place + ".x_mm", fault);
  if (const char* fault = CoordinateFault(point.y_mm())) return Fault(place + ".y_mm", fault);
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
  TRAVERSE_RETURN_IF_ERROR(CheckRange(time.speed_mm_s(), kMaxSpeed, at + ".speed_mm_s"));
  if (time.speed_mm_s() == 0) return Fault(at + ".speed_mm_s", "must be above 0");
  TRAVERSE_RETURN_IF_ERROR(CheckRange(time.accel_mm_s2(), kMaxAcceleration, at + ".accel_mm_s2"));
  TRAVERSE_RETURN_IF_ERROR(
      CheckRange(time.retraction_seconds(), kMaxRetractionSeconds, at + ".retraction_seconds"));
  TRAVERSE_RETURN_IF_ERROR(
      CheckRange(time.retraction_threshold_mm(), kMaxThresholdMm, at + ".retraction_threshold_mm"));
  spec.kind = CostSpec::Kind::kTime;
  spec.speed_mm_s = time.speed_mm_s();
  spec.accel_mm_s2 = time.accel_mm_s2();
  spec.retraction_seconds = time.retraction_seconds();
  spec.retraction_threshold_mm = time.retraction_threshold_mm();
  return spec;
}

}  // namespace traverse
