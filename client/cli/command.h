// The commands of traverse.

#ifndef TRAVERSE_CLIENT_CLI_COMMAND_H_
#define TRAVERSE_CLIENT_CLI_COMMAND_H_

#include <string>
#include <vector>

#include "client/cli/flags/flags.h"
#include "client/cli/outcome.h"

namespace traverse::cli {

// One command: a row of the table. It takes as many operands as `operands` has words.
struct Command {
  std::string name;                        // "optimize"
  std::vector<std::string> operands = {};  // {"INPUT"}
  std::string summary;                     // one line
  std::vector<Flag> flags = {};
  std::string example;  // a whole command line
  Outcome (*run)(const Flags& flags);
};

// All commands, in the order of help.
const std::vector<Command>& Commands();

// Each command's row; the command's file has the rest.
Command OptimizeCommand();
Command CompareCommand();
Command VerifyCommand();
Command InspectCommand();
Command ConvertCommand();
Command StrategiesCommand();
Command ReproduceCommand();
Command CompletionCommand();
Command ManualCommand();

// Runs the command that `arguments` (without the program's name) name. Prints the outcome's message
// to standard error. Returns the exit code.
int Main(const std::vector<std::string>& arguments);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_COMMAND_H_
