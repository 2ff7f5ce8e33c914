#include <algorithm>
#include <cstdio>

#include "absl/strings/str_format.h"
#include "client/cli/command.h"
#include "client/cli/flags/verify_flags.h"
#include "client/cli/gcode_output.h"
#include "client/cli/terminal.h"
#include "client/containers/verify_files.h"
#include "client/files/read_file.h"
#include "client/files/write_file.h"
#include "client/gcode/verify/report.h"
#include "client/report/verify_json.h"

namespace traverse::cli {
namespace {

// Most breaks that are printed; --json has the first of each rule.
constexpr size_t kMostTold = 10;

// The first breaks, and their number by rule, in one text.
absl::Status FaultOf(const VerifyReport& report) {
  std::string text;
  const size_t told = std::min(kMostTold, report.breaks.size());
  for (size_t i = 0; i < told; ++i) {
    text += (i > 0 ? "\n" : "") + report.breaks[i].message;
  }
  if (report.breaks.size() > 1) {
    text += "\nbreaks:";
    for (size_t rule = 0; rule < report.counts.size(); ++rule) {
      if (report.counts[rule] == 0) continue;
      text += absl::StrFormat(" %s %d", std::string(VerifyRuleName(static_cast<VerifyRule>(rule))),
                              report.counts[rule]);
    }
  }
  return absl::FailedPreconditionError(text);
}

Outcome RunVerify(const Flags& flags) {
  const std::string& original_name = flags.operands()[0];
  const std::string& optimised_name = flags.operands()[1];
  if (original_name == "-" && optimised_name == "-") {
    return UsageFault("only one of the two can be standard input");
  }
  const absl::StatusOr<PlateOptions> plates = ParsePlateOptions(flags);
  if (!plates.ok()) return UsageFault(plates.status());
  const auto permissions = ParseGivenPermissions(flags);
  if (!permissions.ok()) return UsageFault(permissions.status());
  absl::StatusOr<std::string> original = ReadWholeFile(original_name);
  if (!original.ok()) return InputFault(original.status());
  absl::StatusOr<std::string> optimised = ReadWholeFile(optimised_name);
  if (!optimised.ok()) return InputFault(optimised.status());
  const auto report = VerifyFiles(*std::move(original), original_name, *std::move(optimised),
                                  optimised_name, {plates->container, plates->plate, *permissions});
  if (!report.ok()) return InputFault(report.status());
  const std::string shown_original = DisplayName(original_name);
  const std::string shown_optimised = DisplayName(optimised_name);
  const std::string json = flags.Text("json");
  if (!json.empty()) {
    const absl::Status written =
        WriteWholeFile(json, report::VerifyJson(shown_original, shown_optimised, *report));
    if (!written.ok()) return InputFault(written);
  }
  if (!report->ok()) return InputFault(FaultOf(*report));
  if (!flags.Switch("quiet")) {
    Print(json == "-" ? stderr : stdout,
          absl::StrFormat("%s prints the same as %s (policy %s)\n", shown_optimised, shown_original,
                          DescribePermissions(report->permissions)));
  }
  return Done();
}

}  // namespace

Command VerifyCommand() {
  return {.name = "verify",
          .operands = {"ORIGINAL", "OPTIMISED"},
          .summary = "Checks that two G-code files print exactly the same.",
          .flags = OfTopic("", Joined(Joined(VerifyFlagTable(), PlateFlagTable()),
                                      {{"json", "FILE", "write the findings, rule by rule"},
                                       {"quiet", "", "print nothing if they do"}})),
          .example = "traverse verify part.gcode part.optimised.gcode",
          .run = RunVerify};
}

}  // namespace traverse::cli
