#include "client/cli/help.h"

#include <map>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace traverse::cli {

std::string FlagUsage(const Flag& flag) {
  if (flag.name.size() == 1) return absl::StrFormat("-%s %s", flag.name, flag.value);
  if (flag.value.empty()) return absl::StrFormat("--%s", flag.name);
  return absl::StrFormat("--%s=%s", flag.name, flag.value);
}

std::string Operands(const Command& command) {
  std::string out;
  for (const std::string& operand : command.operands) out += " " + operand;
  return out;
}

std::string VersionLine() { return absl::StrFormat("traverse %s", TRAVERSE_VERSION); }

std::string GeneralHelp() {
  std::string out =
      "Shortens the travel moves of 3D printers, which deposit nothing.\n\n"
      "usage: traverse COMMAND ...\n\n";
  for (const Command& command : Commands()) {
    absl::StrAppendFormat(&out, "  %-10s  %s\n", command.name, command.summary);
  }
  out +=
      "\n"
      "`traverse COMMAND --help` lists the flags of a command; `traverse --version`.\n"
      "INPUT: DAMAT, sliced G-code (.gcode .bgcode .gcode.3mf .ufp), the API's layers\n"
      "(.json .pb) or GTSPLIB (.gtsp), plain, .gz or .xz; - is standard input.\n"
      "Without --server the optimiser runs inside the command.\n"
      "Exit codes: 0 done, 1 bad input, 2 usage, 3 server unreachable or refused.\n\n"
      "example: traverse compare part.damat --layers=1-5\n";
  return out;
}

std::string FlagHelp(absl::Span<const Flag> flags) {
  constexpr int kWidth = 27;
  std::vector<std::string> topics = {""};
  std::map<std::string, std::string> lines = {{"", ""}};  // by topic
  for (const Flag& flag : flags) {
    if (!lines.contains(flag.topic)) topics.push_back(flag.topic);
    absl::StrAppendFormat(&lines[flag.topic], "  %-*s  %s\n", kWidth, FlagUsage(flag), flag.help);
  }
  std::string out;
  for (const std::string& topic : topics) {
    if (!topic.empty()) absl::StrAppend(&out, "\n", topic, ":\n");
    out += lines[topic];
  }
  return out;
}

std::string CommandHelp(const Command& command) {
  return absl::StrFormat("%s\n\nusage: traverse %s%s%s\n%s\nexample: %s\n", command.summary,
                         command.name, Operands(command), command.flags.empty() ? "" : " [flags]\n",
                         FlagHelp(command.flags), command.example);
}

}  // namespace traverse::cli
