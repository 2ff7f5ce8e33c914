#include "engine/strategy/options/options.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace traverse {
namespace {

absl::Status Fault(const OptionSpec& spec, const std::string& text, const std::string& wanted) {
  return absl::InvalidArgumentError(
      absl::StrCat("options[\"", spec.name, "\"]: \"", text, "\" is not ", wanted));
}

std::string Range(const OptionSpec& spec) {
  return absl::StrCat(" from ", spec.minimum, " to ", spec.maximum);
}

// What the library reads as well is more likely a mistake: spaces, hexadecimal digits, names.
bool IsDecimal(const std::string& text) {
  return text.find_first_not_of("+-.0123456789eE") == std::string::npos;
}

bool InRange(const OptionSpec& spec, double value) {
  return value >= spec.minimum && value <= spec.maximum;
}

}  // namespace

OptionSpec BoolOption(const char* name, bool default_value, const char* description) {
  return OptionSpec{name,       OptionSpec::Type::kBool, default_value ? "true" : "false", 0, 0, {},
                    description};
}

OptionSpec BoundOption(bool default_value) {
  return BoolOption("bound", default_value,
                    "Also compute a lower bound, which limits how much shorter any route can be.");
}

OptionSpec ChainBoundOption() {
  return BoolOption("chain_bound", false,
                    "Also compute a lower bound of all layers together, wherever each one ends.");
}

OptionSpec PureOption(const char* description) { return BoolOption("pure", false, description); }

absl::StatusOr<StrategyOptions::Value> StrategyOptions::ParseValue(const OptionSpec& spec,
                                                                   const std::string& text) {
  Value value;
  value.type = spec.type;
  switch (spec.type) {
    case OptionSpec::Type::kBool:
      if (!absl::SimpleAtob(text, &value.boolean)) return Fault(spec, text, "true or false");
      break;
    case OptionSpec::Type::kInt:
      if (!IsDecimal(text) || !absl::SimpleAtoi(text, &value.integer) ||
          !InRange(spec, static_cast<double>(value.integer))) {
        return Fault(spec, text, absl::StrCat("a whole number", Range(spec)));
      }
      break;
    case OptionSpec::Type::kDouble:
      if (!IsDecimal(text) || !absl::SimpleAtod(text, &value.real) || !std::isfinite(value.real) ||
          !InRange(spec, value.real)) {
        return Fault(spec, text, absl::StrCat("a number", Range(spec)));
      }
      break;
    case OptionSpec::Type::kChoice:
      if (std::find(spec.values.begin(), spec.values.end(), text) == spec.values.end()) {
        return Fault(spec, text, absl::StrCat("one of ", absl::StrJoin(spec.values, ", ")));
      }
      value.text = text;
      break;
  }
  return value;
}

absl::StatusOr<StrategyOptions> StrategyOptions::Parse(
    const std::vector<OptionSpec>& specs, const std::map<std::string, std::string>& texts) {
  StrategyOptions options;
  for (const OptionSpec& spec : specs) {
    const auto text = texts.find(spec.name);
    absl::StatusOr<Value> value =
        ParseValue(spec, text == texts.end() ? spec.default_value : text->second);
    if (!value.ok()) return value.status();
    options.values_.emplace(spec.name, *std::move(value));
  }
  for (const auto& [name, text] : texts) {
    if (options.values_.count(name) > 0) continue;
    const std::string known = absl::StrJoin(
        specs, ", ", [](std::string* out, const OptionSpec& spec) { out->append(spec.name); });
    return absl::InvalidArgumentError(absl::StrCat(
        "options[\"", name, "\"]: no such option; there ",
        specs.empty() ? "are none" : absl::StrCat(specs.size() == 1 ? "is " : "are ", known)));
  }
  return options;
}

}  // namespace traverse
