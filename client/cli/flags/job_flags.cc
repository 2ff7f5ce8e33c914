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

// Puts `flag` and the next flag on one line of the help.
Flag Joint(Flag flag, const std::string& help) {
  flag.joint_help = help;
  return flag;
}

}  // namespace

std::vector<Flag> JobFlagTable() {
  const std::vector<std::string> any;
  return {
      {"option", "NAME=VALUE", "option of the strategy; repeatable", any, /*repeatable=*/true,
       "strategy's option; what else may move"},
      AllowFlag(),
      {"layers", "A-B", "only these layers, counted from 1", any, false,
       "only these layers; time an island rests, s"},
      {"min_revisit", "S", "G-code: least time between layers of an island, s"},
      MaxHiddenTravelFlag(),
      {"deposition",
       "ORDER",
       "sequential (default) or interleaved",
       {"sequential", "interleaved"},
       false,
       "sequential or interleaved; length or time"},
      {"cost", "COST", "length, or time (default of G-code)", {"length", "time"}},
      {"start", "X,Y", "where the head starts, mm (default 0,0)", any, false,
       "head position, mm (0,0); random seed (1)"},
      {"seed", "N", "seed of all random choices (default 1)"},
      {"cleaning_every", "N", "layers between two nozzle cleanings", any, false,
       "layers between cleanings; point, mm"},
      {"cleaning_point", "X,Y", "where to clean the nozzle, mm"},
      {"travel_speed", "MM_S", "travel speed (default: the file's; for time 130, idle time 20.32)",
       any, false, "(default: the file's, or 130, 1250)"},
      {"travel_accel", "MM_S2", "travel acceleration (default: the file's, or 1250)"},
      {"retraction_seconds", "S", "time of one retraction (default: the file's, or 0.1)", any,
       false, "(the file's, or 0.1, 2)"},
      {"retraction_threshold", "MM", "longer moves retract (default: the file's, or 2)"},
      Joint(PolicyFlag(), "safe|balanced|free|fast; keep|fewer|any"),
      CrossingsFlag(),
      {"deadline", "TIME", "time for the whole job, such as 500ms, 30s or 5m", any, false,
       "for all; for a layer (500ms, 30s, 5m)"},
      {"layer_time_limit", "TIME", "time for each layer"},
  };
}

std::vector<Flag> ServiceFlagTable() {
  std::vector<Flag> table = {
      {"server",
       "HOST:PORT,...",
       "servers to call (default: embedded)",
       {},
       false,
       "(default: embedded, all cores)"},
      {"threads", "N", "threads of the embedded service (default: all cores)"},
  };
  for (Flag& flag : ConnectionFlagTable()) table.push_back(std::move(flag));
  return table;
}

Flag PolicyFlag() {
  return {"policy",
          "POLICY",
          "G-code: safe (default), balanced, free or fast",
          {"safe", "balanced", "free", "fast"}};
}

Flag CrossingsFlag() {
  return {"crossings",
          "CROSSINGS",
          "G-code: keep (default), fewer or any crossings",
          {"keep", "fewer", "any"}};
}

Flag AllowFlag() {
  return {"allow", "NAME,...", "infill|wall|fan_order, wipes, inner_detours, ..."};
}

Flag MaxHiddenTravelFlag() {
  return {"max_hidden_travel", "MM", "G-code: longest hidden move, mm (default 30)"};
}

Flag MachineFlag() { return {"machine", "FILE", "printer's limits: klipper.cfg, or M201 to M205"}; }

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
