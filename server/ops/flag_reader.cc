#include "server/ops/flag_reader.h"

#include <absl/flags/reflection.h>

#include <fstream>
#include <map>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/version.h"

namespace traverse {
namespace {

// The flag of this name, or null. Only those of the program: libraries bring some too.
absl::CommandLineFlag* FindFlag(const FlagProgram& program, const std::string& name) {
  absl::CommandLineFlag* flag = absl::FindCommandLineFlag(name);
  return flag != nullptr && absl::EndsWith(flag->Filename(), program.file) ? flag : nullptr;
}

// A flag with its value as written, and the line if it stands in a file.
struct GivenFlag {
  absl::CommandLineFlag* flag;
  std::string value;
  std::string place = {};
};

bool IsFile(const GivenFlag& flag) {
  return flag.flag->Name() == "config" || flag.flag->Name() == "flagfile";
}

// The flag that `argument` states: `--name=value`, `--name value` with `next`, if that is not null;
// for a bool `--name` and `--noname` too. Takes `next` by setting it to null.
absl::StatusOr<GivenFlag> ReadFlag(const FlagProgram& program, const std::string& argument,
                                   const std::string*& next) {
  const size_t begin = argument.find_first_not_of('-');
  if (begin == 0 || begin > 2) {
    return absl::InvalidArgumentError(absl::StrCat("unexpected argument \"", argument, "\""));
  }
  const size_t equals = argument.find('=');
  const std::string name = argument.substr(begin, equals - begin);
  absl::CommandLineFlag* flag = FindFlag(program, name);
  if (flag != nullptr && equals != std::string::npos) {
    return GivenFlag{flag, argument.substr(equals + 1)};
  }
  if (flag != nullptr && flag->IsOfType<bool>()) return GivenFlag{flag, "true"};
  if (flag != nullptr) {
    if (next == nullptr) return BadFlag(name, "the value is missing");
    return GivenFlag{flag, *std::exchange(next, nullptr)};
  }
  if (absl::StartsWith(name, "no") && equals == std::string::npos) {
    flag = FindFlag(program, name.substr(2));
    if (flag != nullptr && flag->IsOfType<bool>()) return GivenFlag{flag, "false"};
  }
  return absl::InvalidArgumentError(
      absl::StrCat("unknown flag --", name, "; --help lists all flags"));
}

// The flags in the lines `name=value` or `--name=value` of a file; `#` begins a comment line.
absl::StatusOr<std::vector<GivenFlag>> FlagsOfFile(const FlagProgram& program,
                                                   const std::string& path) {
  std::ifstream file(path);
  if (!file) return absl::InvalidArgumentError(absl::StrCat(path, ": cannot be read"));
  std::vector<GivenFlag> given;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::string text(absl::StripAsciiWhitespace(line));
    if (text.empty() || text[0] == '#') continue;
    const std::string place = absl::StrCat(path, ":", number, ": ");
    const size_t equals = text.find('=');
    std::string argument = text;
    if (equals != std::string::npos) {
      const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
      argument = absl::StrCat(text[0] == '-' ? "" : "--", absl::StripTrailingAsciiWhitespace(name),
                              "=", absl::StripLeadingAsciiWhitespace(value));
    } else if (text[0] != '-') {
      return absl::InvalidArgumentError(place + "not name=value");
    }
    const std::string* none = nullptr;
    absl::StatusOr<GivenFlag> flag = ReadFlag(program, argument, none);
    if (!flag.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(place, flag.status().message()));
    }
    if (IsFile(*flag)) {
      return absl::InvalidArgumentError(
          absl::StrCat(place, "a file of flags cannot name another one"));
    }
    flag->place = place;
    given.push_back(*std::move(flag));
  }
  return given;
}

// All that the command line and the files on it state, in the order in which it counts.
absl::StatusOr<std::vector<GivenFlag>> GivenFlags(const FlagProgram& program,
                                                  const std::vector<std::string>& arguments) {
  std::vector<GivenFlag> config, given;
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string* next = i + 1 < arguments.size() ? &arguments[i + 1] : nullptr;
    const bool has_next = next != nullptr;
    absl::StatusOr<GivenFlag> flag = ReadFlag(program, arguments[i], next);
    if (!flag.ok()) return flag.status();
    if (has_next && next == nullptr) ++i;
    if (IsFile(*flag) && !flag->value.empty()) {
      absl::StatusOr<std::vector<GivenFlag>> in_file = FlagsOfFile(program, flag->value);
      if (!in_file.ok()) return in_file.status();
      if (flag->flag->Name() == "config") {
        config = *std::move(in_file);
      } else {
        given.insert(given.end(), in_file->begin(), in_file->end());
      }
    }
    given.push_back(*std::move(flag));
  }
  config.insert(config.end(), given.begin(), given.end());
  return config;
}

std::string Help(const FlagProgram& program) {
  std::string text = program.usage;
  std::map<std::string, const absl::CommandLineFlag*> flags;
  for (const auto& [name, flag] : absl::GetAllFlags()) {
    const std::string key(name.data(), name.size());
    if (FindFlag(program, key) != nullptr) flags.emplace(key, flag);
  }
  for (const auto& [name, flag] : flags) {
    absl::StrAppend(&text, "  --", name, "=", flag->DefaultValue(), "\n      ", flag->Help(), "\n");
  }
  return text;
}

}  // namespace

absl::Status CheckLeastValues(const std::vector<LeastValue>& numbers) {
  for (const LeastValue& number : numbers) {
    if (number.value < number.least) {
      return BadFlag(number.name, absl::StrCat(number.value, " is below ", number.least));
    }
  }
  return absl::OkStatus();
}

absl::Status CheckDaemonFlags(absl::Duration drain_timeout,
                              const std::vector<std::string>& allowed_clients,
                              const std::string& tls_client_ca) {
  if (drain_timeout < absl::ZeroDuration()) return BadFlag("drain_timeout", "below 0");
  if (!allowed_clients.empty() && tls_client_ca.empty()) {
    return BadFlag("allowed_clients", "needs --tls_client_ca");
  }
  return absl::OkStatus();
}

absl::StatusOr<std::map<std::string, double>> ParseWeights(const std::vector<std::string>& flag) {
  std::map<std::string, double> weights;
  for (const std::string& entry : flag) {
    const size_t equals = entry.rfind('=');
    double weight = 0;
    if (equals == std::string::npos || equals == 0 ||
        !absl::SimpleAtod(entry.substr(equals + 1), &weight) || !(weight > 0 && weight <= 1000)) {
      return BadFlag("caller_weights",
                     absl::StrCat("'", entry, "' is not CALLER=WEIGHT with a weight up to 1000"));
    }
    weights[entry.substr(0, equals)] = weight;
  }
  return weights;
}

absl::Status BadFlag(const std::string& name, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat("--", name, ": ", what));
}

absl::StatusOr<std::string> ReadProgramFlags(const FlagProgram& program,
                                             const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    if (argument == "--help" || argument == "-h") return Help(program);
    if (argument == "--version") return absl::StrCat(program.name, " ", kVersion, "\n");
  }
  const absl::StatusOr<std::vector<GivenFlag>> given = GivenFlags(program, arguments);
  if (!given.ok()) return given.status();
  for (const GivenFlag& one : *given) {
    std::string error;  // says no more than that
    if (one.flag->ParseFrom(one.value, &error)) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(one.place, "\"", one.value, "\" is not a value of --", one.flag->Name()));
  }
  if (absl::Status status = program.check(); !status.ok()) return status;
  return std::string();
}

}  // namespace traverse
