#include "client/cli/help.h"

#include <algorithm>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"

namespace traverse::cli {
namespace {

std::string Usage(const Flag& flag) {
  if (flag.name.size() == 1) return absl::StrFormat("-%s %s", flag.name, flag.value);
  if (flag.value.empty()) return absl::StrFormat("--%s", flag.name);
  return absl::StrFormat("--%s=%s", flag.name, flag.value);
}

}  // namespace

std::string VersionLine() { return absl::StrFormat("traverse %s", TRAVERSE_VERSION); }

std::string GeneralHelp() {
  std::string out =
      "Shortens the travel of 3D printers: the moves on which nothing is deposited.\n\n"
      "usage: traverse COMMAND ...\n\n";
  for (const Command& command : Commands()) {
    const std::string usage =
        absl::StrFormat("%s %s", command.name, absl::StrJoin(command.operands, " "));
    absl::StrAppendFormat(&out, "  %-16s %s\n", usage, command.summary);
  }
  out +=
      "\n`traverse COMMAND --help` lists the flags of a command; `traverse --version`.\n"
      "INPUT: DAMAT, sliced G-code, or the API's layers as .json or .pb; plain, .gz or .xz;\n"
      "       - is standard input. Without --server the service runs inside the command.\n"
      "Exit codes: 0 done, 1 fault in the input, 2 usage, 3 server unreachable or refused.\n\n"
      "example: traverse compare part.damat --layers=1-5\n";
  return out;
}

std::string CommandHelp(const Command& command) {
  std::string out = absl::StrFormat("%s\n\nusage: traverse %s %s [flags]\n\n", command.summary,
                                    command.name, absl::StrJoin(command.operands, " "));
  size_t width = 0;
  for (const Flag& flag : command.flags) width = std::max(width, Usage(flag).size());
  for (const Flag& flag : command.flags) {
    absl::StrAppendFormat(&out, "  %-*s  %s\n", static_cast<int>(width), Usage(flag), flag.help);
  }
  for (const std::string& example : command.examples) {
    absl::StrAppendFormat(&out, "\nexample: %s", example);
  }
  return out + "\n";
}

}  // namespace traverse::cli
