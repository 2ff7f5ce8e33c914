#include <cstdio>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/command.h"
#include "client/cli/flags/job_flags.h"
#include "client/cli/service.h"
#include "client/cli/terminal.h"
#include "client/files/write_file.h"
#include "client/formats/api_format.h"

namespace traverse::cli {
namespace {

// "=true", "=sp (sp, nrp, bbcp)", "=250 (1 to 1e+06)".
std::string Value(const v1::OptionInfo& option) {
  std::string out = "=" + option.default_value();
  if (option.values_size() > 0) {
    absl::StrAppendFormat(&out, " (%s)", absl::StrJoin(option.values(), ", "));
  } else if (option.has_minimum() && option.has_maximum()) {
    absl::StrAppendFormat(&out, " (%g to %g)", option.minimum(), option.maximum());
  }
  return out;
}

std::string Describe(const v1::ListStrategiesResponse& listed) {
  std::string out;
  for (const v1::StrategyInfo& info : listed.strategies()) {
    const bool is_default = info.name() == listed.default_strategy();
    absl::StrAppendFormat(&out, "%s%s%s\n  %s\n", info.name(), is_default ? " (default)" : "",
                          info.lower_bound() ? ", with lower bound" : "", info.summary());
    for (const v1::OptionInfo& option : info.options()) {
      absl::StrAppendFormat(&out, "    %s%s\n        %s\n", option.name(), Value(option),
                            option.description());
    }
  }
  const std::string words = absl::StrJoin(listed.capabilities(), ", ");
  // In brackets: the lines that begin with a word are those of strategies.
  absl::StrAppendFormat(&out, "(server %s, capabilities: %s)\n", listed.server_version(),
                        words.empty() ? "none" : words);
  return out;
}

Outcome RunStrategies(const Flags& flags) {
  Expected<Service> opened = Service::Open(flags);
  if (Outcome* outcome = std::get_if<Outcome>(&opened)) return *outcome;
  Expected<v1::ListStrategiesResponse> listed = std::get<Service>(opened).ListStrategies();
  if (Outcome* outcome = std::get_if<Outcome>(&listed)) return *outcome;
  const auto& response = std::get<v1::ListStrategiesResponse>(listed);
  if (!flags.Has("json")) {
    Print(stdout, Describe(response));
    return Done();
  }
  const absl::StatusOr<std::string> document = ApiMessageJson(response);
  if (!document.ok()) return InputFault(document.status());
  const absl::Status status = WriteWholeFile(flags.Text("json"), *document);
  return status.ok() ? Done() : InputFault(status);
}

}  // namespace

Command StrategiesCommand() {
  return {.name = "strategies",
          .summary = "Lists the strategies, with their options and defaults.",
          .flags = Joined({{"json", "FILE", "write the list and the capabilities as JSON"}},
                          ServiceFlagTable()),
          .example = "traverse strategies --server=farm-1:50051",
          .run = RunStrategies};
}

}  // namespace traverse::cli
