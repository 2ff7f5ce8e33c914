#include "client/cli/flags/job_flags.h"

#include <limits>

#include "absl/status/status.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "client/cli/flags/connection_flags.h"
#include "client/cli/flags/machine_file.h"
#include "client/cli/flags/strategy_spec.h"
#include "client/files/read_file.h"

namespace traverse::cli {
namespace {

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
    return absl::InvalidArgumentError(
        absl::StrFormat("--layers=%s: not A-B, positions counted from 1", text));
  }
  return std::make_pair(first, last);
}

absl::StatusOr<std::optional<v1::Cleaning>> ParseCleaning(const Flags& flags) {
  if (flags.Has("cleaning_every") != flags.Has("cleaning_point")) {
    return absl::InvalidArgumentError(
        "--cleaning_every and --cleaning_point must be given together");
  }
  const auto every = flags.Integer("cleaning_every", 1, std::numeric_limits<int32_t>::max());
  if (!every.ok()) return every.status();
  const auto point = flags.Pair("cleaning_point");
  if (!point.ok()) return point.status();
  if (!*every) return std::nullopt;
  v1::Cleaning cleaning;
  cleaning.set_every_layers(static_cast<uint32_t>(**every));
  *cleaning.mutable_point() = ToPoint(**point);
  return cleaning;
}

// The least acceleration that the service takes; 0 stands for unlimited.
constexpr double kLeastAccelMmS2 = 1e-3;

absl::StatusOr<CostSettings> ParseCost(const Flags& flags) {
  CostSettings cost;
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
  if (status.ok()) status = read("retraction_threshold", 0, 1e7, cost.retraction_threshold_mm);
  if (!status.ok()) return status;
  if (cost.accel_mm_s2 && *cost.accel_mm_s2 > 0 && *cost.accel_mm_s2 < kLeastAccelMmS2) {
    return absl::InvalidArgumentError(
        absl::StrFormat("--travel_accel=%s: not 0 or a number from %g to 1e+07",
                        flags.Text("travel_accel"), kLeastAccelMmS2));
  }
  return cost;
}

// `fault` begins with the name of a setting, which is also the name of the flag.
absl::Status AsFlagFault(const absl::Status& fault) {
  return fault.ok() ? fault : absl::InvalidArgumentError(absl::StrCat("--", fault.message()));
}

}  // namespace

namespace {

absl::StatusOr<gcode::MachineLimits> ReadMachine(const std::string& name) {
  absl::StatusOr<gcode::MachineLimits> limits = ReadMachineFile(name);
  if (limits.ok()) return limits;
  return absl::InvalidArgumentError(absl::StrCat("--machine: ", limits.status().message()));
}

}  // namespace

std::vector<Flag> JobFlagTable() {
  const std::vector<Flag> job = {
      {"option", "NAME=VALUE", "option of the strategy; repeatable", {}, /*repeatable=*/true},
      {"layers", "A-B", "only these layers, counted from 1"},
      {"deposition", "ORDER", "sequential (default) or interleaved", {"sequential", "interleaved"}},
      {"start", "X,Y", "where the head starts, mm (default 0,0)"},
      {"seed", "N", "seed of all random choices (default 1)"},
      {"cleaning_every", "N", "layers between two nozzle cleanings"},
      {"cleaning_point", "X,Y", "where to clean the nozzle, mm"},
      {"deadline", "TIME", "time for the whole job: 500ms, 30s, 5m"},
      {"layer_time_limit", "TIME", "time for each layer"},
  };
  const std::vector<Flag> cost = {
      {"cost", "COST", "length, or time (default of G-code)", {"length", "time"}},
      {"travel_speed", "MM_S", "travel speed (default: the file's, or 130)"},
      {"travel_accel", "MM_S2", "travel acceleration (the file's, or 1250)"},
      {"retraction_seconds", "S", "time of one retraction (the file's, or 0.1)"},
      {"retraction_threshold", "MM", "longer moves retract (the file's, or 2)"},
  };
  const std::vector<Flag> freedom = {
      PolicyFlag(),
      CrossingsFlag(),
      AllowFlag(),
      MaxHiddenTravelFlag(),
      {.name = "min_revisit",
       .value = "S",
       .help = "least time between layers of an island, s",
       .topic = kSlicedTopic},
  };
  return Joined(freedom, Joined(OfTopic("Job", job), OfTopic("What a move costs", cost)));
}

std::vector<Flag> ServiceFlagTable() {
  return OfTopic("Service",
                 Joined(
                     {
                         {"server", "HOST:PORT,...", "servers to call (default: embedded)"},
                         {"threads", "N", "of the embedded service (default: all cores)"},
                     },
                     ConnectionFlagTable()));
}

Flag PolicyFlag() {
  return {.name = "policy",
          .value = "POLICY",
          .help = "safe (default), balanced, free or fast",
          .choices = {"safe", "balanced", "free", "fast"},
          .topic = kSlicedTopic};
}

Flag CrossingsFlag() {
  return {.name = "crossings",
          .value = "CROSSINGS",
          .help = "visible walls crossed: keep (default), fewer, any",
          .choices = {"keep", "fewer", "any"},
          .topic = kSlicedTopic};
}

Flag AllowFlag() {
  return {.name = "allow",
          .value = "NAME,...",
          .help = "infill_order, wall_order, fan_order, wipes, ...",
          .topic = kSlicedTopic};
}

Flag MaxHiddenTravelFlag() {
  return {.name = "max_hidden_travel",
          .value = "MM",
          .help = "longest hidden move, mm (default 30)",
          .topic = kSlicedTopic};
}

Flag MachineFlag() {
  return {.name = "machine",
          .value = "FILE",
          .help = "printer's limits: klipper.cfg, or M201 to M205",
          .topic = kSlicedTopic};
}

absl::StatusOr<GcodeOptions> ParseGcodeOptions(const Flags& flags) {
  GcodeOptions options;
  const std::string allow = flags.Text("allow");
  const std::optional<gcode::Allowance> allowed = gcode::AllowanceOfNames(allow);
  if (!allowed) {
    return absl::InvalidArgumentError(
        absl::StrFormat("--allow=%s: not infill_order, wall_order, fan_order, wipes, "
                        "hidden_retractions or inner_detours, or several separated by commas",
                        allow));
  }
  options.allow = *allowed;
  const auto hidden = flags.Number("max_hidden_travel", 0, gcode::kMostHiddenTravelMm);
  if (!hidden.ok()) return hidden.status();
  options.allow.max_hidden_travel_mm = hidden->value_or(gcode::kMaxHiddenTravelMm);
  const auto revisit = flags.Number("min_revisit", 0, GcodeOptions::kMostRevisitSeconds);
  if (!revisit.ok()) return revisit.status();
  options.min_revisit_seconds = revisit->value_or(0);
  if (flags.Has("machine")) {
    absl::StatusOr<gcode::MachineLimits> machine = ReadMachine(flags.Text("machine"));
    if (!machine.ok()) return machine.status();
    options.machine = *std::move(machine);
  }
  // The flag's choices allow no other text.
  options.policy = gcode::PolicyOfName(flags.Text("policy", "safe")).value_or(options.policy);
  options.crossings =
      gcode::CrossingsOfName(flags.Text("crossings", "keep")).value_or(options.crossings);
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

absl::Status ApplyJobFlags(const JobFlags& flags, InputJob& job) {
  return AsFlagFault(ApplySettings(flags, job));
}

absl::Status SelectJobLayers(const JobFlags& flags, InputJob& job) {
  return AsFlagFault(SelectLayers(flags, job));
}

}  // namespace traverse::cli
