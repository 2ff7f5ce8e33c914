// Help texts, built from the tables of commands and flags.

#ifndef TRAVERSE_CLIENT_CLI_HELP_H_
#define TRAVERSE_CLIENT_CLI_HELP_H_

#include <string>

#include "absl/types/span.h"
#include "client/cli/command.h"

namespace traverse::cli {

// What `traverse --help` prints.
std::string GeneralHelp();

// What `traverse COMMAND --help` prints: usage, flags, an example.
std::string CommandHelp(const Command& command);

// A line for each flag, under the names of their topics.
std::string FlagHelp(absl::Span<const Flag> flags);

// "--seed=N", "-o OUTPUT", "--quiet".
std::string FlagUsage(const Flag& flag);

// " ORIGINAL OPTIMISED": a command's operands, each after a blank.
std::string Operands(const Command& command);

// "traverse 0.1.0".
std::string VersionLine();

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_HELP_H_
