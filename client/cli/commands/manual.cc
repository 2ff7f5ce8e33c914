// The man page, made from the tables of commands and flags.

#include <cstdio>
#include <string>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/cli/command.h"
#include "client/cli/help.h"
#include "client/cli/terminal.h"

namespace traverse::cli {
namespace {

// Text for roff: backslashes and dashes as they are typed, no line that begins like a request.
std::string Roff(const std::string& text) {
  std::string out = absl::StrReplaceAll(text, {{"\\", "\\e"}, {"-", "\\-"}});
  if (out.starts_with('.') || out.starts_with('\'')) out.insert(0, "\\&");
  return out;
}

std::string CommandText(const Command& command) {
  std::string out = absl::StrFormat(".SS traverse %s%s\n%s\n", command.name,
                                    Roff(Operands(command)), Roff(command.summary));
  for (const Flag& flag : command.flags) {
    absl::StrAppendFormat(&out, ".TP\n.B %s\n%s\n", Roff(FlagUsage(flag)), Roff(flag.help));
    if (!flag.choices.empty()) {
      absl::StrAppendFormat(&out, "(%s)\n", absl::StrJoin(flag.choices, ", "));
    }
  }
  absl::StrAppendFormat(&out, ".PP\nExample:\n.PP\n.nf\n    %s\n.fi\n", Roff(command.example));
  return out;
}

std::string Page() {
  std::string out = absl::StrFormat(
      ".TH TRAVERSE 1 \"\" \"%s\" \"User Commands\"\n"
      ".SH NAME\n"
      "traverse \\- shortens the travel of 3D printers\n"
      ".SH SYNOPSIS\n"
      ".B traverse\n"
      ".I COMMAND\n"
      ".RI [ FLAG ]...\n"
      ".RI [ INPUT ]\n"
      ".SH DESCRIPTION\n"
      "Finds a shorter way through the paths of every layer: their order, the vertex at which "
      "each\n"
      "contour is begun, the direction of each line. What is printed stays the same.\n"
      ".PP\n"
      "INPUT is a DAMAT part, sliced G\\-code, the layers of the API as .json or .pb, or an\n"
      "instance of GTSPLIB (.gtsp), plain or compressed by gzip or xz. It is recognised by\n"
      "content, then by extension; \\- is standard\n"
      "input. Without \\-\\-server the service runs inside the command.\n"
      ".PP\n"
      "G\\-code is text, binary G\\-code (.bgcode), or plates in an archive (.gcode.3mf, .ufp).\n"
      "It is written in the container that it came in; OUTPUT named .gcode gets the text, one\n"
      "named .bgcode binary G\\-code. Of an archive all plates are optimised, or the one of\n"
      "\\-\\-plate, and MD5 sums beside them are made anew.\n"
      ".PP\n"
      "Flags are written \\-\\-name=value or \\-\\-name value. Durations are written as 500ms, "
      "30s\n"
      "or 1m30s.\n"
      ".SH COMMANDS\n",
      Roff(VersionLine()));
  for (const Command& command : Commands()) out += CommandText(command);
  out +=
      ".SH EXIT STATUS\n"
      ".TP\n.B 0\ndone\n"
      ".TP\n.B 1\nthe input could not be read, optimised or verified; it is left as it was\n"
      ".TP\n.B 2\nthe command line is wrong\n"
      ".TP\n.B 3\nthe server could not be reached or refused\n"
      ".SH ENVIRONMENT\n"
      ".TP\n.B NO_COLOR\nif set and not empty, tables have no colors\n"
      ".TP\n.B GRPC_VERBOSITY\nDEBUG, INFO or ERROR show what gRPC has to say\n";
  return out;
}

Outcome RunManual(const Flags&) {
  Print(stdout, Page());
  return Done();
}

}  // namespace

Command ManualCommand() {
  return {.name = "manual",
          .summary = "Prints the man page.",
          .example = "traverse manual | man -l -",
          .run = RunManual};
}

}  // namespace traverse::cli
