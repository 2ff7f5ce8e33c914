#include <algorithm>
#include <climits>
#include <map>
#include <utility>

#include "absl/strings/match.h"
#include "engine/strategy/registry.h"
#include "server/translate.h"
#include "server/translate_check.h"

namespace traverse {
namespace {

constexpr size_t kMaxJobIdBytes = 256;
constexpr double kMaxIdleSpeed = 1e5;
constexpr int64_t kMaxDurationSeconds = 315'576'000'000;  // of google.protobuf.Duration
constexpr int32_t kNanosPerSecond = 1'000'000'000;

// A limit of time, above 0.
absl::StatusOr<absl::Duration> Limit(const google::protobuf::Duration& limit,
                                     const std::string& place) {
  const int64_t seconds = limit.seconds();
  const int32_t nanos = limit.nanos();
  if (seconds > kMaxDurationSeconds || seconds < -kMaxDurationSeconds || nanos >= kNanosPerSecond ||
      nanos <= -kNanosPerSecond || (seconds > 0 && nanos < 0) || (seconds < 0 && nanos > 0)) {
    return Fault(place, "not a valid duration");
  }
  const absl::Duration duration = absl::Seconds(seconds) + absl::Nanoseconds(nanos);
  if (duration <= absl::ZeroDuration()) {
    return Fault(place, absl::StrCat(absl::FormatDuration(duration), " is not above 0"));
  }
  return duration;
}

absl::StatusOr<CleaningSpec> CleaningFromProto(const v1::Cleaning& cleaning) {
  const std::string place = "options.cleaning";
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(cleaning, place));
  if (!cleaning.has_point()) return Fault(place + ".point", "missing");
  absl::StatusOr<Point> point = PointFromProto(cleaning.point(), place + ".point");
  if (!point.ok()) return point.status();
  if (cleaning.every_layers() < 1) return Fault(place + ".every_layers", "0 is not at least 1");
  if (cleaning.every_layers() > INT_MAX) {
    return Fault(place + ".every_layers",
                 absl::StrCat(cleaning.every_layers(), " is above ", INT_MAX));
  }
  if (cleaning.layers_since_cleaning() >= cleaning.every_layers()) {
    return Fault(place + ".layers_since_cleaning",
                 absl::StrCat(cleaning.layers_since_cleaning(), " is not less than every_layers, ",
                              cleaning.every_layers()));
  }
  return CleaningSpec{*point, static_cast<int>(cleaning.every_layers()),
                      static_cast<int>(cleaning.layers_since_cleaning())};
}

absl::Status SetStrategy(const v1::Strategy& strategy, JobSetup& setup) {
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(strategy, "options.strategy"));
  setup.strategy_name = strategy.name().empty() ? DefaultStrategyName() : strategy.name();
  const std::map<std::string, std::string> options(strategy.options().begin(),
                                                   strategy.options().end());
  absl::StatusOr<std::unique_ptr<Strategy>> made = MakeStrategy(setup.strategy_name, options);
  if (!made.ok()) {
    return absl::Status(made.status().code(),
                        absl::StrCat("options.strategy.", made.status().message()));
  }
  setup.strategy = *std::move(made);
  return absl::OkStatus();
}

absl::Status SetEnums(const v1::JobOptions& options, JobSetup& setup) {
  if (!v1::Deposition_IsValid(options.deposition())) {
    return Fault("options.deposition", absl::StrCat(options.deposition(), " is no deposition"));
  }
  if (!v1::ResultOrder_IsValid(options.result_order())) {
    return Fault("options.result_order", absl::StrCat(options.result_order(), " is no order"));
  }
  setup.interleaved = options.deposition() == v1::DEPOSITION_INTERLEAVED;
  setup.build_order = options.result_order() == v1::RESULT_ORDER_BUILD;
  return absl::OkStatus();
}

absl::Status SetLimits(const v1::JobOptions& options, JobSetup& setup) {
  if (options.has_time_limit()) {
    absl::StatusOr<absl::Duration> limit = Limit(options.time_limit(), "options.time_limit");
    if (!limit.ok()) return limit.status();
    setup.time_limit = *limit;
  }
  if (options.has_layer_time_limit()) {
    absl::StatusOr<absl::Duration> limit =
        Limit(options.layer_time_limit(), "options.layer_time_limit");
    if (!limit.ok()) return limit.status();
    setup.spec.layer_time_limit = *limit;
  }
  return absl::OkStatus();
}

absl::Status SetGeometry(const v1::JobOptions& options, JobSetup& setup) {
  if (options.has_start()) {
    absl::StatusOr<Point> start = PointFromProto(options.start(), "options.start");
    if (!start.ok()) return start.status();
    setup.spec.start = *start;
  }
  if (options.has_cleaning()) {
    absl::StatusOr<CleaningSpec> cleaning = CleaningFromProto(options.cleaning());
    if (!cleaning.ok()) return cleaning.status();
    setup.spec.cleaning = *cleaning;
  }
  if (options.has_cost()) {
    absl::StatusOr<CostSpec> cost = CostFromProto(options.cost(), "options.cost");
    if (!cost.ok()) return cost.status();
    setup.spec.cost = *cost;
  }
  if (options.has_idle_speed_mm_s()) {
    const double speed = options.idle_speed_mm_s();
    if (!(speed > 0) || speed > kMaxIdleSpeed) {
      return Fault("options.idle_speed_mm_s",
                   absl::StrCat(speed, " is not above 0 and at most ", kMaxIdleSpeed));
    }
    setup.idle_speed_mm_s = speed;
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<JobSetup> JobFromProto(const v1::JobOptions& options) {
  JobSetup setup;
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(options, "options"));
  if (options.job_id().size() > kMaxJobIdBytes) {
    return Fault("options.job_id",
                 absl::StrCat(options.job_id().size(), " bytes, more than ", kMaxJobIdBytes));
  }
  setup.job_id = options.job_id();
  TRAVERSE_RETURN_IF_ERROR(SetStrategy(options.strategy(), setup));
  TRAVERSE_RETURN_IF_ERROR(SetEnums(options, setup));
  TRAVERSE_RETURN_IF_ERROR(SetLimits(options, setup));
  TRAVERSE_RETURN_IF_ERROR(SetGeometry(options, setup));
  setup.look_ahead = options.look_ahead();
  setup.spec.seed = options.has_seed() ? options.seed() : 1;
  return setup;
}

}  // namespace traverse
