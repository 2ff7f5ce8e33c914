#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/match.h"
#include "engine/strategy/registry.h"
#include "server/translate/fault_list.h"
#include "server/translate/field_ranges.h"
#include "server/translate/translate.h"
#include "server/translate/translate_check.h"

namespace traverse {
namespace {

constexpr size_t kMaxJobIdBytes = 256;
// No name and no value of an option is longer. A longer one would fill the log.
constexpr size_t kMaxNameBytes = 64;
constexpr double kMostWorthSpeed = 1e5;                   // mm/s, as of JobOptions.idle_speed_mm_s
constexpr int64_t kMaxDurationSeconds = 315'576'000'000;  // of google.protobuf.Duration
constexpr int32_t kNanosPerSecond = 1'000'000'000;

// A limit of time.
absl::StatusOr<absl::Duration> Limit(const google::protobuf::Duration& limit,
                                     const FieldRange& range, const std::string& place) {
  const int64_t seconds = limit.seconds();
  const int32_t nanos = limit.nanos();
  if (nanos >= kNanosPerSecond || nanos <= -kNanosPerSecond || (seconds > 0 && nanos < 0) ||
      (seconds < 0 && nanos > 0)) {
    return Fault(place, "not a valid duration");
  }
  const absl::Duration duration = absl::Seconds(seconds) + absl::Nanoseconds(nanos);
  if (absl::AbsDuration(duration) > absl::Seconds(kMaxDurationSeconds)) {
    return Fault(place, "not a valid duration");
  }
  TRAVERSE_RETURN_IF_ERROR(CheckRange(range, absl::ToDoubleSeconds(duration), place));
  return duration;
}

absl::StatusOr<CleaningSpec> CleaningFromProto(const v1::Cleaning& cleaning) {
  const std::string place = "options.cleaning";
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(cleaning, place));
  if (!cleaning.has_point()) return Fault(place + ".point", "missing");
  absl::StatusOr<Point> point = PointFromProto(cleaning.point(), place + ".point");
  if (!point.ok()) return point.status();
  TRAVERSE_RETURN_IF_ERROR(CheckRange(RangeOf("Cleaning.every_layers"), cleaning.every_layers(),
                                      place + ".every_layers"));
  if (cleaning.layers_since_cleaning() >= cleaning.every_layers()) {
    return Fault(place + ".layers_since_cleaning",
                 absl::StrCat(cleaning.layers_since_cleaning(), " is not less than every_layers, ",
                              cleaning.every_layers()));
  }
  return CleaningSpec{*point, static_cast<int>(cleaning.every_layers()),
                      static_cast<int>(cleaning.layers_since_cleaning())};
}

absl::Status CheckLength(const std::string& text, const std::string& place) {
  if (text.size() <= kMaxNameBytes) return absl::OkStatus();
  return Fault(place, absl::StrCat("\"", Beginning(text, kMaxNameBytes), "...\" has ", text.size(),
                                   " bytes, more than ", kMaxNameBytes));
}

absl::Status CheckLengths(const v1::Strategy& strategy) {
  const std::string place = "options.strategy";
  TRAVERSE_RETURN_IF_ERROR(CheckLength(strategy.name(), place + ".name"));
  for (const auto& [name, value] : strategy.options()) {
    TRAVERSE_RETURN_IF_ERROR(CheckLength(name, place + ".options"));
    TRAVERSE_RETURN_IF_ERROR(CheckLength(value, absl::StrCat(place, ".options[\"", name, "\"]")));
  }
  return absl::OkStatus();
}

// The speed at which `auto` judges what its search is worth: that of travel, where it is known, and
// unless the caller says how long to search.
std::optional<double> WorthSpeed(const v1::JobOptions& options) {
  const auto& asked = options.strategy().options();
  for (const char* name : {"effort", "least_gain_each", "idle_speed"}) {
    if (asked.contains(name)) return std::nullopt;
  }
  if (options.has_idle_speed_mm_s()) return options.idle_speed_mm_s();
  if (options.cost().has_time()) return options.cost().time().speed_mm_s();
  return std::nullopt;
}

absl::Status SetStrategy(const v1::JobOptions& job, JobSetup& setup) {
  const v1::Strategy& strategy = job.strategy();
  TRAVERSE_RETURN_IF_ERROR(CheckKnown(strategy, "options.strategy"));
  TRAVERSE_RETURN_IF_ERROR(CheckLengths(strategy));
  setup.strategy_name = strategy.name().empty() ? DefaultStrategyName() : strategy.name();
  std::map<std::string, std::string> options(strategy.options().begin(), strategy.options().end());
  const std::optional<double> speed = WorthSpeed(job);
  // A speed out of range is a fault of its own.
  if (setup.strategy_name == "auto" && speed && *speed > 0 && *speed <= kMostWorthSpeed)
    options["idle_speed"] = absl::StrCat(*speed);
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
    return Fault("options.deposition", absl::StrCat(options.deposition(), " is not a deposition"));
  }
  if (!v1::ResultOrder_IsValid(options.result_order())) {
    return Fault("options.result_order", absl::StrCat(options.result_order(), " is not an order"));
  }
  setup.interleaved = options.deposition() == v1::DEPOSITION_INTERLEAVED;
  setup.build_order = options.result_order() == v1::RESULT_ORDER_BUILD;
  return absl::OkStatus();
}

absl::Status SetLimits(const v1::JobOptions& options, JobSetup& setup) {
  FaultList faults;
  if (options.has_time_limit()) {
    absl::StatusOr<absl::Duration> limit =
        Limit(options.time_limit(), RangeOf("JobOptions.time_limit"), "options.time_limit");
    faults.Add(limit.status());
    if (limit.ok()) setup.time_limit = *limit;
  }
  if (options.has_layer_time_limit()) {
    absl::StatusOr<absl::Duration> limit =
        Limit(options.layer_time_limit(), RangeOf("JobOptions.layer_time_limit"),
              "options.layer_time_limit");
    faults.Add(limit.status());
    if (limit.ok()) setup.spec.layer_time_limit = *limit;
  }
  return faults.status();
}

absl::Status SetGeometry(const v1::JobOptions& options, JobSetup& setup) {
  FaultList faults;
  if (options.has_start()) {
    absl::StatusOr<Point> start = PointFromProto(options.start(), "options.start");
    faults.Add(start.status());
    if (start.ok()) setup.spec.start = *start;
  }
  if (options.has_cleaning()) {
    absl::StatusOr<CleaningSpec> cleaning = CleaningFromProto(options.cleaning());
    faults.Add(cleaning.status());
    if (cleaning.ok()) setup.spec.cleaning = *cleaning;
  }
  if (options.has_cost()) {
    absl::StatusOr<CostSpec> cost = CostFromProto(options.cost(), "options.cost");
    faults.Add(cost.status());
    if (cost.ok()) setup.spec.cost = *cost;
  }
  if (options.has_idle_speed_mm_s()) {
    const double speed = options.idle_speed_mm_s();
    faults.Add(CheckRange(RangeOf("JobOptions.idle_speed_mm_s"), speed, "options.idle_speed_mm_s"));
    setup.idle_speed_mm_s = speed;
  }
  return faults.status();
}

}  // namespace

absl::StatusOr<JobSetup> JobFromProto(const v1::JobOptions& options) {
  JobSetup setup;
  FaultList faults;
  faults.Add(CheckKnown(options, "options"));
  if (options.job_id().size() > kMaxJobIdBytes) {
    faults.Add(Fault("options.job_id",
                     absl::StrCat(options.job_id().size(), " bytes, more than ", kMaxJobIdBytes)));
  }
  setup.job_id = options.job_id();
  faults.Add(SetStrategy(options, setup));
  faults.Add(SetEnums(options, setup));
  faults.Add(SetLimits(options, setup));
  faults.Add(SetGeometry(options, setup));
  if (!faults.empty()) return faults.status();
  setup.validate_only = options.validate_only();
  setup.partial_answers = options.partial_answers();
  setup.look_ahead = options.look_ahead();
  setup.spec.seed = options.has_seed() ? options.seed() : 1;
  return setup;
}

}  // namespace traverse
