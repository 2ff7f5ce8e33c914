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

// Text for roff: escapes backslashes and dashes, and lines that begin like a request.
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
      "Shortens the travel moves of every layer: chooses the order of its paths, the vertex at\n"
      "which each contour starts, and the direction of each line. What is printed stays the\n"
      "same.\n"
      ".PP\n"
      "INPUT is a DAMAT part, sliced G\\-code, the layers of the API as .json or .pb, or an\n"
      "instance of GTSPLIB (.gtsp), plain or compressed by gzip or xz. The content decides the\n"
      "format, and the extension where the content leaves it open; \\- is standard input.\n"
      "Without \\-\\-server the optimiser runs inside the command.\n"
      ".PP\n"
      "G\\-code is text, binary G\\-code (.bgcode), or plates in an archive (.gcode.3mf, .ufp).\n"
      "The output has the format of the input, unless OUTPUT ends in .gcode (text) or .bgcode\n"
      "(binary). All plates of an archive are optimised, or the one that \\-\\-plate names, and\n"
      "their MD5 sums are renewed.\n"
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
      ".TP\n.B 1\nthe input could not be read, optimised or verified; it stays unchanged\n"
      ".TP\n.B 2\nthe command line is wrong\n"
      ".TP\n.B 3\nthe server could not be reached or refused\n"
      ".SH ENVIRONMENT\n"
      ".TP\n.B NO_COLOR\nif set and not empty, tables are not colored\n"
      ".TP\n.B GRPC_VERBOSITY\nDEBUG, INFO or ERROR print gRPC's own messages\n";
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
