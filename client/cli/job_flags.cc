#include "client/cli/job_flags.h"

#include <limits>

#include "absl/status/status.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "client/cli/connection_flags.h"
#include "client/cli/strategy_spec.h"

namespace traverse::cli {
namespace {

// A fast desktop printer of our days; --help states them.
constexpr double kDefaultSpeedMmS = 130;
constexpr double kDefaultAccelMmS2 = 1250;
constexpr double kDefaultRetractionSeconds = 0.1;
constexpr double kDefaultRetractionThresholdMm = 2;

absl::Status Fault(std::string message) { return absl::InvalidArgumentError(std::move(message)); }

v1::Point ToPoint(const std::pair<double, double>& pair) {
  v1::Point point;
  point.set_x_mm(pair.first);
  point.set_y_mm(pair.second);
  return point;
}

absl::StatusOr<std::optional<std::pair<uint64_t, uint64_t>>> ParseLayers(const Flags& flags) {
  if (!flags.Has("layers")) return std::nullopt;
  const std::string text = flags.Text("layers");
  const std::vector<std::string> ends = absl::StrSplit(text, '-');
  uint64_t first = 0;
  uint64_t last = 0;
  const bool digits = text.find_first_not_of("0123456789-") == std::string::npos;
  if (!digits || ends.size() > 2 || !absl::SimpleAtoi(ends.front(), &first) ||
      !absl::SimpleAtoi(ends.back(), &last) || first < 1 || last < first) {
    return Fault(absl::StrFormat("--layers=%s: not A-B, two positions from 1", text));
  }
  return std::make_pair(first, last);
}

absl::StatusOr<std::optional<v1::Cleaning>> ParseCleaning(const Flags& flags) {
  if (flags.Has("cleaning_every") != flags.Has("cleaning_point")) {
    return Fault("--cleaning_every and --cleaning_point go together");
  }
  const auto every = flags.Integer("cleaning_every", 1, std::numeric_limits<uint32_t>::max());
  if (!every.ok()) return every.status();
  const auto point = flags.Pair("cleaning_point");
  if (!point.ok()) return point.status();
  if (!*every) return std::nullopt;
  v1::Cleaning cleaning;
  cleaning.set_every_layers(static_cast<uint32_t>(**every));
  *cleaning.mutable_point() = ToPoint(**point);
  return cleaning;
}

absl::StatusOr<CostFlags> ParseCost(const Flags& flags) {
  CostFlags cost;
  if (flags.Has("cost")) cost.by_time = flags.Text("cost") == "time";
  const auto read = [&](const char* name, double least, double most,
                        std::optional<double>& value) -> absl::Status {
    const auto number = flags.Number(name, least, most);
    if (number.ok()) value = *number;
    return number.status();
  };
  absl::Status status = read("travel_speed", 1e-3, 1e5, cost.speed_mm_s);
  if (status.ok()) status = read("travel_accel", 0, 1e7, cost.accel_mm_s2);
  if (status.ok()) status = read("retraction_seconds", 0, 1e4, cost.retraction_seconds);
  if (status.ok()) status = read("retraction_threshold", 0, 1e6, cost.retraction_threshold_mm);
  if (!status.ok()) return status;
  return cost;
}

// Overrides `model` by the flags. A time model that the file does not state begins with the
// defaults.
void ApplyCost(const CostFlags& flags, v1::CostModel& model) {
  const bool by_time = flags.by_time.value_or(model.has_time());
  if (!by_time) {
    model.mutable_length();
    return;
  }
  if (!model.has_time()) {
    v1::TimeCost& time = *model.mutable_time();
    time.set_speed_mm_s(kDefaultSpeedMmS);
    time.set_accel_mm_s2(kDefaultAccelMmS2);
    time.set_retraction_seconds(kDefaultRetractionSeconds);
    time.set_retraction_threshold_mm(kDefaultRetractionThresholdMm);
  }
  v1::TimeCost& time = *model.mutable_time();
  if (flags.speed_mm_s) time.set_speed_mm_s(*flags.speed_mm_s);
  if (flags.accel_mm_s2) time.set_accel_mm_s2(*flags.accel_mm_s2);
  if (flags.retraction_seconds) time.set_retraction_seconds(*flags.retraction_seconds);
  if (flags.retraction_threshold_mm) {
    time.set_retraction_threshold_mm(*flags.retraction_threshold_mm);
  }
}

// Idle time is stated at the speed that the cost counts with, if there is one.
void ApplyIdleSpeed(const CostFlags& flags, v1::JobOptions& options) {
  if (flags.speed_mm_s) {
    options.set_idle_speed_mm_s(*flags.speed_mm_s);
  } else if (options.cost().has_time() && !options.has_idle_speed_mm_s()) {
    options.set_idle_speed_mm_s(options.cost().time().speed_mm_s());
  }
}

}  // namespace

std::vector<Flag> JobFlagTable() {
  const std::vector<std::string> any;
  return {
      {"option", "NAME=VALUE", "an option of the strategy; repeatable", any, /*repeatable=*/true},
      {"layers", "A-B", "only these, counted from 1"},
      {"deposition", "ORDER", "sequential (default) or interleaved", {"sequential", "interleaved"}},
      {"start", "X,Y", "where the head is at first, mm (default 0,0)"},
      {"cleaning_every", "N", "layers between two nozzle cleanings", any, false,
       "nozzle cleaning, mm"},
      {"cleaning_point", "X,Y", "where the nozzle is cleaned, mm"},
      {"cost", "COST", "length, or time (default of G-code)", {"length", "time"}},
      {"travel_speed", "MM_S", "travel speed (default: the file's; for time 130, idle time 20.32)",
       any, false, "(default: the file's, or 130, 1250)"},
      {"travel_accel", "MM_S2", "travel acceleration (default: the file's, or 1250)"},
      {"retraction_seconds", "S", "time of one retraction (default: the file's, or 0.1)", any,
       false, "(the file's, or 0.1, 2)"},
      {"retraction_threshold", "MM", "longer moves retract (default: the file's, or 2)"},
      PolicyFlag(),
      {"seed", "N", "of all random choices (default 1)"},
      {"deadline", "TIME", "the answer is due within it, such as 500ms, 30s or 5m", any, false,
       "such as 500ms, 30s, 5m"},
      {"layer_time_limit", "TIME", "most time for one layer"},
  };
}

std::vector<Flag> ServiceFlagTable() {
  std::vector<Flag> table = {
      {"server",
       "HOST:PORT,...",
       "the servers to ask (default: embedded)",
       {},
       false,
       "(default: embedded, all cores)"},
      {"threads", "N", "of the embedded service (default: all cores)"},
  };
  for (Flag& flag : ConnectionFlagTable()) table.push_back(std::move(flag));
  return table;
}

Flag PolicyFlag() {
  return {
      "policy", "POLICY", "G-code: safe (default), balanced or free", {"safe", "balanced", "free"}};
}

GcodeOptions ParseGcodeOptions(const Flags& flags) {
  GcodeOptions options;
  // The flag's own choices leave no other text.
  options.policy = gcode::PolicyOfName(flags.Text("policy", "safe")).value_or(options.policy);
  return options;
}

absl::StatusOr<JobFlags> ParseJobFlags(const Flags& flags) {
  JobFlags out;
  for (const std::string& text : flags.All("option")) {
    const auto option = ParseOption(text);
    if (!option.ok()) return option.status();
    out.strategy_options.push_back(*option);
  }
  if (flags.Has("deposition")) {
    out.deposition = flags.Text("deposition") == "interleaved" ? v1::DEPOSITION_INTERLEAVED
                                                               : v1::DEPOSITION_SEQUENTIAL;
  }
  const auto layers = ParseLayers(flags);
  if (!layers.ok()) return layers.status();
  const auto cleaning = ParseCleaning(flags);
  if (!cleaning.ok()) return cleaning.status();
  const auto start = flags.Pair("start");
  if (!start.ok()) return start.status();
  const auto cost = ParseCost(flags);
  if (!cost.ok()) return cost.status();
  const auto seed = flags.Integer("seed", 0, std::numeric_limits<uint64_t>::max());
  if (!seed.ok()) return seed.status();
  const auto deadline = flags.Duration("deadline");
  if (!deadline.ok()) return deadline.status();
  const auto layer_time_limit = flags.Duration("layer_time_limit");
  if (!layer_time_limit.ok()) return layer_time_limit.status();

  out.layers = *layers;
  out.cleaning = *cleaning;
  if (*start) out.start = ToPoint(**start);
  out.cost = *cost;
  out.seed = *seed;
  out.deadline = deadline->value_or(absl::InfiniteDuration());
  out.layer_time_limit = *layer_time_limit;
  return out;
}

absl::Status SelectLayers(const JobFlags& flags, InputJob& job) {
  if (!flags.layers) return absl::OkStatus();
  const auto [first, last] = *flags.layers;
  if (last > job.layers.size()) {
    return Fault(
        absl::StrFormat("--layers=%d-%d: the file has %d layers", first, last, job.layers.size()));
  }
  const auto cut = [first = first, last = last](auto& list) {
    if (list.empty()) return;
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(last), list.end());
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(first - 1));
  };
  cut(job.layers);
  cut(job.notes);
  job.first_layer = first - 1;
  return absl::OkStatus();
}

namespace {

google::protobuf::Duration ToProto(absl::Duration duration) {
  const int64_t nanos = absl::ToInt64Nanoseconds(duration);
  google::protobuf::Duration out;
  out.set_seconds(nanos / 1'000'000'000);
  out.set_nanos(static_cast<int32_t>(nanos % 1'000'000'000));
  return out;
}

}  // namespace

absl::Status ApplyJobFlags(const JobFlags& flags, InputJob& job) {
  if (absl::Status status = SelectLayers(flags, job); !status.ok()) return status;
  v1::JobOptions& options = job.options;
  if (flags.deposition) options.set_deposition(*flags.deposition);
  if (flags.cleaning) *options.mutable_cleaning() = *flags.cleaning;
  if (flags.start) *options.mutable_start() = *flags.start;
  if (flags.seed) options.set_seed(*flags.seed);
  if (flags.time_limit) *options.mutable_time_limit() = ToProto(*flags.time_limit);
  if (flags.layer_time_limit) {
    *options.mutable_layer_time_limit() = ToProto(*flags.layer_time_limit);
  }
  ApplyCost(flags.cost, *options.mutable_cost());
  ApplyIdleSpeed(flags.cost, options);
  for (v1::Layer& layer : job.layers) {
    if (layer.has_cost()) ApplyCost(flags.cost, *layer.mutable_cost());
  }
  return absl::OkStatus();
}

}  // namespace traverse::cli
