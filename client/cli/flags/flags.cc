#include "client/cli/flags/flags.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/flags/nearest.h"

namespace traverse::cli {
namespace {

absl::Status BadValue(const std::string& name, const std::string& value, const std::string& want) {
  return absl::InvalidArgumentError(absl::StrFormat("--%s=%s: %s", name, value, want));
}

std::string Dashed(const std::string& name) { return (name.size() == 1 ? "-" : "--") + name; }

// Nothing if `text` is not entirely a number.
template <typename T>
std::optional<T> ParseNumber(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

const Flag* Find(absl::Span<const Flag> table, const std::string& name) {
  const auto flag = std::find_if(table.begin(), table.end(),
                                 [&](const Flag& candidate) { return candidate.name == name; });
  return flag == table.end() ? nullptr : &*flag;
}

// `typed` includes the dashes that were given, which may be the only mistake.
absl::Status Unknown(absl::Span<const Flag> table, const std::string& typed,
                     const std::string& name) {
  if (Find(table, name) != nullptr) {
    return absl::InvalidArgumentError(
        absl::StrFormat("unknown flag %s; did you mean %s?", typed, Dashed(name)));
  }
  std::vector<std::string> names;
  for (const Flag& flag : table) {
    if (flag.name.size() > 1) names.push_back(flag.name);
  }
  return absl::InvalidArgumentError(
      absl::StrFormat("unknown flag %s%s", typed, DidYouMean(name, names, "--")));
}

absl::Status CheckValue(const Flag& flag, const std::string& value) {
  if (flag.value.empty()) {
    if (value == "true" || value == "false") return absl::OkStatus();
    return BadValue(flag.name, value, "takes no value");
  }
  if (flag.choices.empty()) return absl::OkStatus();
  if (std::find(flag.choices.begin(), flag.choices.end(), value) != flag.choices.end()) {
    return absl::OkStatus();
  }
  return BadValue(flag.name, value,
                  absl::StrFormat("not one of %s%s", absl::StrJoin(flag.choices, ", "),
                                  DidYouMean(value, flag.choices)));
}

}  // namespace

std::vector<Flag> OfTopic(const std::string& topic, std::vector<Flag> table) {
  for (Flag& flag : table) flag.topic = topic;
  return table;
}

std::vector<Flag> Joined(std::vector<Flag> table, const std::vector<Flag>& more) {
  table.insert(table.end(), more.begin(), more.end());
  return table;
}

absl::StatusOr<Flags> Flags::Parse(absl::Span<const Flag> table,
                                   absl::Span<const std::string> arguments) {
  Flags flags;
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--") {
      flags.operands_.insert(flags.operands_.end(), arguments.begin() + i + 1, arguments.end());
      break;
    }
    if (argument.size() < 2 || argument[0] != '-') {  // "-" is standard input
      flags.operands_.push_back(argument);
      continue;
    }
    const size_t begin = argument.starts_with("--") ? 2 : 1;
    const size_t equals = argument.find('=');
    std::string name = argument.substr(begin, equals - begin);
    std::replace(name.begin(), name.end(), '-', '_');
    const Flag* flag = Find(table, name);
    if (flag == nullptr || (begin == 1) != (name.size() == 1)) {
      return Unknown(table, argument.substr(0, equals), name);
    }

    std::string value = "true";
    if (equals != std::string::npos) {
      value = argument.substr(equals + 1);
    } else if (!flag->value.empty()) {
      // The next flag is not a value: otherwise --json --quiet writes a file named --quiet.
      if (++i == arguments.size() || arguments[i].starts_with("--")) {
        return absl::InvalidArgumentError(
            absl::StrFormat("%s needs a value: %s", Dashed(name), flag->value));
      }
      value = arguments[i];
    }
    if (absl::Status status = CheckValue(*flag, value); !status.ok()) return status;
    std::vector<std::string>& values = flags.values_[name];
    if (!flag->repeatable) values.clear();
    values.push_back(std::move(value));
  }
  return flags;
}

std::string Flags::Text(const std::string& name, const std::string& unset) const {
  const auto values = values_.find(name);
  return values == values_.end() ? unset : values->second.back();
}

std::vector<std::string> Flags::All(const std::string& name) const {
  const auto values = values_.find(name);
  return values == values_.end() ? std::vector<std::string>() : values->second;
}

absl::StatusOr<std::optional<double>> Flags::Number(const std::string& name, double least,
                                                    double most) const {
  if (!Has(name)) return std::nullopt;
  const std::optional<double> value = ParseNumber<double>(Text(name));
  if (!value || !(*value >= least && *value <= most)) {
    return BadValue(name, Text(name), absl::StrFormat("not a number from %g to %g", least, most));
  }
  return value;
}

absl::StatusOr<std::optional<uint64_t>> Flags::Integer(const std::string& name, uint64_t least,
                                                       uint64_t most) const {
  if (!Has(name)) return std::nullopt;
  const std::optional<uint64_t> value = ParseNumber<uint64_t>(Text(name));
  if (!value || *value < least || *value > most) {
    return BadValue(name, Text(name),
                    absl::StrFormat("not a whole number from %d to %d", least, most));
  }
  return value;
}

absl::StatusOr<std::optional<absl::Duration>> Flags::Duration(const std::string& name) const {
  if (!Has(name)) return std::nullopt;
  absl::Duration value;
  if (!absl::ParseDuration(Text(name), &value) || value < absl::Nanoseconds(1)) {
    return BadValue(name, Text(name), "not a duration of at least 1ns, such as 500ms, 30s or 5m");
  }
  return value;
}

absl::StatusOr<std::optional<std::pair<double, double>>> Flags::Pair(
    const std::string& name) const {
  if (!Has(name)) return std::nullopt;
  const std::string text = Text(name);
  const size_t comma = text.find(',');
  const std::optional<double> x = ParseNumber<double>(std::string_view(text).substr(0, comma));
  const std::optional<double> y =
      comma == std::string::npos ? std::nullopt
                                 : ParseNumber<double>(std::string_view(text).substr(comma + 1));
  constexpr double kMax = 1e6;
  if (!x || !y || !(std::abs(*x) <= kMax) || !(std::abs(*y) <= kMax)) {
    return BadValue(name, text, "not a point X,Y within +-1e6 mm");
  }
  return std::make_pair(*x, *y);
}

}  // namespace traverse::cli
