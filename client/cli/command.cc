#include "client/cli/command.h"

#include <google/protobuf/stubs/logging.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/cli/flags/nearest.h"
#include "client/cli/help.h"
#include "client/cli/terminal.h"

namespace traverse::cli {
namespace {

const Command* Find(const std::string& name) {
  for (const Command& command : Commands()) {
    if (command.name == name) return &command;
  }
  return nullptr;
}

Outcome UnknownCommand(const std::string& name) {
  std::vector<std::string> names;
  for (const Command& command : Commands()) names.push_back(command.name);
  return UsageFault(
      absl::StrFormat("traverse: unknown command \"%s\"%s", name, DidYouMean(name, names)));
}

bool AsksForHelp(const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    if (argument == "--") return false;
    if (argument == "--help" || argument == "-h") return true;
  }
  return false;
}

Outcome RunCommand(const Command& command, const std::vector<std::string>& arguments) {
  if (AsksForHelp(arguments)) {
    Print(stdout, CommandHelp(command));
    return Done();
  }
  const auto usage = [&](const std::string& message) {
    return UsageFault(absl::StrFormat("traverse %s: %s", command.name, message));
  };
  const absl::StatusOr<Flags> flags = Flags::Parse(command.flags, arguments);
  if (!flags.ok()) return usage(std::string(flags.status().message()));
  const size_t given = flags->operands().size();
  if (given < command.operands.size()) {
    return usage(absl::StrFormat("%s is missing; see traverse %s --help", command.operands[given],
                                 command.name));
  }
  if (given > command.operands.size()) {
    return usage(absl::StrFormat("unexpected argument \"%s\"; see traverse %s --help",
                                 flags->operands()[command.operands.size()], command.name));
  }
  Outcome outcome = command.run(*flags);
  return outcome.code == kUsageFault ? usage(outcome.message) : outcome;
}

Outcome Run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    return UsageFault("traverse: no command given; see traverse --help");
  }
  const std::string& first = arguments.front();
  if (first == "--help" || first == "-h" || first == "help") {
    const Command* topic = arguments.size() > 1 ? Find(arguments[1]) : nullptr;
    Print(stdout, topic == nullptr ? GeneralHelp() : CommandHelp(*topic));
    return Done();
  }
  if (first == "--version") {
    Print(stdout, VersionLine() + "\n");
    return Done();
  }
  const Command* command = Find(first);
  if (command == nullptr) return UnknownCommand(first);
  return RunCommand(*command, {arguments.begin() + 1, arguments.end()});
}

}  // namespace

const std::vector<Command>& Commands() {
  static const std::vector<Command> commands = {
      OptimizeCommand(),  CompareCommand(),    VerifyCommand(),
      InspectCommand(),   ConvertCommand(),    StrategiesCommand(),
      ReproduceCommand(), CompletionCommand(), ManualCommand(),
  };
  return commands;
}

int Main(const std::vector<std::string>& arguments) {
  // protobuf prints parse errors itself; our messages say the same and name the file.
  google::protobuf::SetLogHandler(nullptr);
  // gRPC prints errors too; set this variable to see them.
  setenv("GRPC_VERBOSITY", "NONE", /*overwrite=*/0);
  const Outcome outcome = Run(arguments);
  if (!outcome.message.empty()) Print(stderr, outcome.message + "\n");
  return outcome.code;
}

}  // namespace traverse::cli
