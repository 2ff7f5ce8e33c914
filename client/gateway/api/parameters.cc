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

// Listed by name: a flag that names a file would name one on the gateway's machine.
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
    "max_hidden_travel",
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

// Rewords messages of the command line for a request.
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

absl::StatusOr<absl::Duration> ParseDeadline(const Parameters& parameters) {
  std::vector<cli::Flag> table = cli::JobFlagTable();
  std::erase_if(table, [](const cli::Flag& flag) { return flag.name != "deadline"; });
  const absl::StatusOr<cli::Flags> flags = FlagsOf(table, parameters);
  if (!flags.ok()) return flags.status();
  const absl::StatusOr<cli::JobFlags> job = cli::ParseJobFlags(*flags);
  if (!job.ok()) return InTheseWords(job.status());
  return job->deadline;
}

absl::StatusOr<std::optional<GivenPermissions>> ParseVerifyParameters(
    const Parameters& parameters) {
  const absl::StatusOr<cli::Flags> flags = FlagsOf(cli::VerifyFlagTable(), parameters);
  if (!flags.ok()) return flags.status();
  auto permissions = cli::ParseGivenPermissions(*flags);
  if (!permissions.ok()) return InTheseWords(permissions.status());
  return permissions;
}

}  // namespace traverse::gateway
