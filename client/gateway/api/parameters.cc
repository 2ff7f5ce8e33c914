#include "client/gateway/api/parameters.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "client/cli/flags/job_flags.h"
#include "client/cli/flags/strategy_spec.h"
#include "client/cli/flags/verify_flags.h"
#include "client/cli/gcode_output.h"
#include "client/gateway/http/target.h"

namespace traverse::gateway {
namespace {

// By name: a flag that names a file would name one of the gateway's machine.
constexpr std::array kAllowed = {
    "option",
    "layers",
    "cost",
    "travel_speed",
    "travel_accel",
    "policy",
    "retraction_seconds",
    "retraction_threshold",
    "seed",
    "deadline",
    "layer_time_limit",
    "allow",
    "crossings",
    "min_revisit",
    "container",
    "plate",
    "ignore_md5",
};

bool IsAllowed(const std::string& name) {
  return std::find(kAllowed.begin(), kAllowed.end(), name) != kAllowed.end();
}

bool IsName(const std::string& name) {
  return !name.empty() &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == name.npos;
}

absl::Status Fault(std::string message) { return absl::InvalidArgumentError(std::move(message)); }

// Messages of the command line, in the words of a request.
absl::Status InTheseWords(const absl::Status& status) {
  return Fault(
      absl::StrReplaceAll(std::string(status.message()), {{"flag --", "parameter "}, {"--", ""}}));
}

absl::Status SetStrategy(const cli::Flags& flags, FileRequest& request) {
  if (!flags.Has("strategy")) return absl::OkStatus();
  auto specs = cli::ParseStrategySpecs(flags.Text("strategy"));
  if (!specs.ok()) return InTheseWords(specs.status());
  if (specs->size() != 1) return Fault("strategy takes one strategy");
  request.strategy = specs->front().strategy;
  return absl::OkStatus();
}

}  // namespace

std::vector<cli::Flag> ParameterTable() {
  std::vector<cli::Flag> table = {
      {"name", "FILE", "the file's name in messages (default: the upload's name)"},
      {"report", "", "add the page that shows each layer before and after"},
      {"restate_times", "", "renew print times in M73, headers and metadata"},
      {"strategy", "NAME", "NAME or NAME:OPTION=VALUE (default: by the file's format)"},
  };
  for (const auto& rows : {cli::JobFlagTable(), cli::ContainerFlagTable()}) {
    for (const cli::Flag& flag : rows) {
      if (IsAllowed(flag.name)) table.push_back(flag);
    }
  }
  return table;
}

namespace {

absl::StatusOr<cli::Flags> FlagsOf(const std::vector<cli::Flag>& table,
                                   const Parameters& parameters) {
  std::vector<std::string> arguments;
  std::set<std::string> seen;
  for (const auto& [name, value] : parameters) {
    if (!IsName(name)) return Fault(absl::StrCat("unknown parameter \"", name, "\""));
    if (name != "option" && !seen.insert(name).second) {
      return Fault(absl::StrCat("parameter ", name, " is given twice"));
    }
    arguments.push_back(absl::StrCat("--", name, "=", value));
  }
  absl::StatusOr<cli::Flags> flags = cli::Flags::Parse(table, arguments);
  if (!flags.ok()) return InTheseWords(flags.status());
  return flags;
}

}  // namespace

absl::StatusOr<FileRequest> ParseParameters(const Parameters& parameters) {
  const absl::StatusOr<cli::Flags> flags = FlagsOf(ParameterTable(), parameters);
  if (!flags.ok()) return flags.status();
  absl::StatusOr<cli::JobFlags> job = cli::ParseJobFlags(*flags);
  if (!job.ok()) return InTheseWords(job.status());

  FileRequest request;
  request.settings = *job;
  request.strategy_options = job->strategy_options;
  request.deadline = job->deadline;
  absl::StatusOr<GcodeOptions> gcode = cli::ParseGcodeOptions(*flags);
  if (!gcode.ok()) return InTheseWords(gcode.status());
  request.gcode = *std::move(gcode);
  request.report = flags->Switch("report");
  request.restate_times = flags->Switch("restate_times");
  absl::StatusOr<PlateOptions> plates = cli::ParsePlateOptions(*flags);
  if (!plates.ok()) return InTheseWords(plates.status());
  request.plates = *plates;
  if (flags->Has("container")) {
    request.container =
        flags->Text("container") == "text" ? ContainerKind::kText : ContainerKind::kBgcode;
  }
  if (absl::Status status = SetStrategy(*flags, request); !status.ok()) return status;
  if (flags->Has("name")) {
    request.name = flags->Text("name");
    if (absl::Status status = CheckFileName(request.name); !status.ok()) return status;
  }
  return request;
}

absl::StatusOr<std::optional<GivenPermissions>> ParseVerifyParameters(
    const Parameters& parameters) {
  const absl::StatusOr<cli::Flags> flags = FlagsOf(cli::VerifyFlagTable(), parameters);
  if (!flags.ok()) return flags.status();
  auto permissions = cli::ParseGivenPermissions(*flags);
  if (!permissions.ok()) return InTheseWords(permissions.status());
  return permissions;
}

namespace {

absl::Status NoneKnown(const std::string& field, int value) {
  return Fault(absl::StrCat("options.", field, ": ", value, " is unknown"));
}

absl::Status SetPolicy(const v1::RewriteOptions& options, GcodeOptions& gcode) {
  switch (options.policy()) {
    case v1::POLICY_UNSPECIFIED:
    case v1::POLICY_SAFE:
      return absl::OkStatus();
    case v1::POLICY_BALANCED:
      gcode.policy = gcode::Policy::kBalanced;
      return absl::OkStatus();
    case v1::POLICY_FREE:
      gcode.policy = gcode::Policy::kFree;
      return absl::OkStatus();
    default:
      return NoneKnown("policy", options.policy());
  }
}

absl::Status SetCrossings(const v1::RewriteOptions& options, GcodeOptions& gcode) {
  switch (options.crossings()) {
    case v1::CROSSINGS_UNSPECIFIED:
    case v1::CROSSINGS_KEEP:
      return absl::OkStatus();
    case v1::CROSSINGS_FEWER:
      gcode.crossings = gcode::Crossings::kFewer;
      return absl::OkStatus();
    case v1::CROSSINGS_ANY:
      gcode.crossings = gcode::Crossings::kAny;
      return absl::OkStatus();
    default:
      return NoneKnown("crossings", options.crossings());
  }
}

// For both messages with a field `allow`, and both structs with a member for each value.
template <typename Options, typename Allowed>
absl::Status SetAllowances(const Options& options, Allowed& allow) {
  constexpr int kMost = 16;
  if (options.allow_size() > kMost) {
    return Fault(absl::StrCat("options.allow: ", options.allow_size(), " values, more than 16"));
  }
  for (int i = 0; i < options.allow_size(); ++i) {
    switch (options.allow(i)) {
      case v1::ALLOWANCE_INFILL_ORDER:
        allow.infill_order = true;
        break;
      case v1::ALLOWANCE_WALL_ORDER:
        allow.wall_order = true;
        break;
      case v1::ALLOWANCE_FAN_ORDER:
        allow.fan_order = true;
        break;
      default:
        return NoneKnown(absl::StrCat("allow[", i, "]"), options.allow(i));
    }
  }
  return absl::OkStatus();
}

absl::Status SetWhatMayMove(const v1::RewriteOptions& options, GcodeOptions& gcode) {
  if (absl::Status status = SetPolicy(options, gcode); !status.ok()) return status;
  if (absl::Status status = SetCrossings(options, gcode); !status.ok()) return status;
  if (absl::Status status = SetAllowances(options, gcode.allow); !status.ok()) return status;
  // Not so of a number that is none.
  if (!(options.min_revisit_s() >= 0 &&
        options.min_revisit_s() <= GcodeOptions::kMostRevisitSeconds)) {
    return Fault("options.min_revisit_s: not within 0 to 3600");
  }
  gcode.min_revisit_seconds = options.min_revisit_s();
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<FileRequest> RequestOf(const v1::RewriteOptions& options) {
  FileRequest request;
  if (!options.name().empty()) {
    if (absl::Status status = CheckFileName(options.name()); !status.ok()) {
      return Fault(absl::StrCat("options.name: ", status.message()));
    }
    request.name = options.name();
  }
  if (absl::Status status = SetWhatMayMove(options, request.gcode); !status.ok()) return status;
  if (options.has_strategy()) request.strategy = options.strategy();
  if (options.has_seed()) request.settings.seed = options.seed();
  const uint32_t first = std::max(1u, options.first_layer());
  if (options.last_layer() != 0 || first > 1) {
    if (options.last_layer() < first) {
      return Fault(options.last_layer() == 0
                       ? "options.last_layer: required where first_layer is set"
                       : "options.last_layer: below first_layer");
    }
    request.settings.layers = {first, options.last_layer()};
  }
  if (options.has_layer_time_limit()) {
    const absl::Duration limit = absl::Seconds(options.layer_time_limit().seconds()) +
                                 absl::Nanoseconds(options.layer_time_limit().nanos());
    if (limit <= absl::ZeroDuration()) return Fault("options.layer_time_limit: not above 0");
    request.settings.layer_time_limit = limit;
  }
  request.report = options.report();
  return request;
}

absl::StatusOr<std::optional<GivenPermissions>> PermissionsOf(const v1::VerifyOptions& options) {
  if (options.policy() == v1::POLICY_UNSPECIFIED && options.allow().empty()) return std::nullopt;
  GivenPermissions given;
  switch (options.policy()) {
    case v1::POLICY_UNSPECIFIED:
      given.policy_as_stated = true;
      break;
    case v1::POLICY_SAFE:
      break;
    case v1::POLICY_BALANCED:
      given.permissions.policy = VerifyPermissions::Policy::kBalanced;
      break;
    case v1::POLICY_FREE:
      given.permissions.policy = VerifyPermissions::Policy::kFree;
      break;
    default:
      return NoneKnown("policy", options.policy());
  }
  if (absl::Status status = SetAllowances(options, given.permissions); !status.ok()) return status;
  return given;
}

}  // namespace traverse::gateway
