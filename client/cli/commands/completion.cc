// Scripts that complete command lines in bash and zsh, made from the tables of commands and flags.

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

std::string CommandNames() {
  std::string out;
  for (const Command& command : Commands()) out += (out.empty() ? "" : " ") + command.name;
  return out;
}

// "--seed= --quiet -o": what may follow a command.
std::string FlagWords(const Command& command) {
  std::string out;
  for (const Flag& flag : command.flags) {
    const char* dashes = flag.name.size() == 1 ? "-" : "--";
    const char* end = flag.name.size() == 1 || flag.value.empty() ? "" : "=";
    absl::StrAppendFormat(&out, "%s%s%s ", dashes, flag.name, end);
  }
  return out + "--help";
}

// bash: words by command, values of flags with choices, and files for everything else.
std::string Bash() {
  std::string out =
      "# bash completion for traverse. Load it: eval \"$(traverse completion bash)\"\n"
      "_traverse() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} flag='' words=''\n"
      "  COMPREPLY=()\n"
      "  # bash splits --flag=value at the equals sign.\n"
      "  if [ \"$word\" = '=' ]; then flag=$before word=''\n"
      "  elif [ \"$before\" = '=' ]; then flag=${COMP_WORDS[COMP_CWORD-2]}; fi\n";
  absl::StrAppendFormat(&out,
                        "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
                        "    COMPREPLY=($(compgen -W '%s --help --version' -- \"$word\"))\n"
                        "    return\n"
                        "  fi\n"
                        "  case \"${COMP_WORDS[1]} $flag\" in\n",
                        CommandNames());
  for (const Command& command : Commands()) {
    for (const Flag& flag : command.flags) {
      if (flag.choices.empty()) continue;
      absl::StrAppendFormat(&out, "    '%s --%s') words='%s' ;;\n", command.name, flag.name,
                            absl::StrJoin(flag.choices, " "));
    }
    absl::StrAppendFormat(&out, "    '%s ') words='%s' ;;\n", command.name, FlagWords(command));
  }
  out +=
      "  esac\n"
      "  if [ -n \"$flag\" ] && [ -n \"$words\" ]; then\n"
      "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
      "  elif [ -z \"$flag\" ] && [[ $word == -* ]]; then\n"
      "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
      "    [[ ${COMPREPLY[0]-} == *= ]] && compopt -o nospace\n"
      "  else\n"
      "    compopt -o filenames\n"
      "    COMPREPLY=($(compgen -f -- \"$word\"))\n"
      "  fi\n"
      "}\n"
      "complete -F _traverse traverse\n";
  return out;
}

// Text between single quotes of zsh's _arguments, where [ ] and : are special.
std::string ZshText(const std::string& text) {
  return absl::StrReplaceAll(text, {{"'", "'\\''"}, {"[", "\\["}, {"]", "\\]"}, {":", "\\:"}});
}

std::string ZshFlag(const Flag& flag) {
  const std::string help = ZshText(flag.help);
  const char* repeat = flag.repeatable ? "*" : "";
  if (flag.name.size() == 1) return absl::StrFormat("'-%s[%s]:file:_files'", flag.name, help);
  if (flag.value.empty()) return absl::StrFormat("'--%s[%s]'", flag.name, help);
  std::string action = flag.value.find("FILE") != std::string::npos ? "_files" : "";
  if (!flag.choices.empty()) action = absl::StrFormat("(%s)", absl::StrJoin(flag.choices, " "));
  return absl::StrFormat("'%s--%s=[%s]:%s:%s'", repeat, flag.name, help, ZshText(flag.value),
                         action);
}

std::string Zsh() {
  std::string out =
      "#compdef traverse\n"
      "# zsh completion for traverse. Load it: source <(traverse completion zsh)\n"
      "_traverse() {\n"
      "  local -a commands\n"
      "  commands=(\n";
  for (const Command& command : Commands()) {
    absl::StrAppendFormat(&out, "    '%s:%s'\n", command.name, ZshText(command.summary));
  }
  out +=
      "  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe command commands\n"
      "    return\n"
      "  fi\n"
      "  local command=$words[2]\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $command in\n";
  for (const Command& command : Commands()) {
    absl::StrAppendFormat(&out, "    %s)\n      _arguments \\\n", command.name);
    for (const Flag& flag : command.flags)
      absl::StrAppendFormat(&out, "        %s \\\n", ZshFlag(flag));
    out += "        '*:file:_files' ;;\n";
  }
  out +=
      "  esac\n"
      "}\n"
      "compdef _traverse traverse\n";
  return out;
}

Outcome RunCompletion(const Flags& flags) {
  const std::string& shell = flags.operands()[0];
  if (shell != "bash" && shell != "zsh") {
    return UsageFault(absl::StrFormat("\"%s\" is neither bash nor zsh", shell));
  }
  Print(stdout, shell == "bash" ? Bash() : Zsh());
  return Done();
}

}  // namespace

Command CompletionCommand() {
  return {.name = "completion",
          .operands = {"SHELL"},
          .summary = "Prints the completion script for bash or zsh.",
          .example = "eval \"$(traverse completion bash)\"",
          .run = RunCompletion};
}

}  // namespace traverse::cli
