#include <cstdio>

#include "absl/strings/str_format.h"
#include "client/cli/command.h"
#include "client/cli/terminal.h"
#include "client/files/read_file.h"
#include "client/gcode/verify/verifier.h"

namespace traverse::cli {
namespace {

Outcome RunVerify(const Flags& flags) {
  const std::string& original_name = flags.operands()[0];
  const std::string& optimised_name = flags.operands()[1];
  if (original_name == "-" && optimised_name == "-") {
    return UsageFault("only one of the two can be standard input");
  }
  const absl::StatusOr<std::string> original = ReadWholeFile(original_name);
  if (!original.ok()) return InputFault(original.status());
  const absl::StatusOr<std::string> optimised = ReadWholeFile(optimised_name);
  if (!optimised.ok()) return InputFault(optimised.status());
  const absl::Status same =
      VerifyGcode(*original, DisplayName(original_name), *optimised, DisplayName(optimised_name));
  if (!same.ok()) return InputFault(same);
  if (!flags.Switch("quiet")) {
    Print(stdout, absl::StrFormat("%s prints what %s prints\n", DisplayName(optimised_name),
                                  DisplayName(original_name)));
  }
  return Done();
}

}  // namespace

Command VerifyCommand() {
  Command command;
  command.name = "verify";
  command.operands = {"ORIGINAL", "OPTIMISED"};
  command.summary = "Does the second G-code print exactly what the first prints?";
  command.flags = {{"quiet", "", "nothing if it does"}};
  command.example = "traverse verify part.gcode part.optimised.gcode";
  command.run = RunVerify;
  return command;
}

}  // namespace traverse::cli
