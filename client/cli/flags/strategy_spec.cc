#include "client/cli/flags/strategy_spec.h"

#include <utility>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "client/cli/flags/nearest.h"

namespace traverse::cli {
namespace {

const v1::StrategyInfo* FindStrategy(const v1::ListStrategiesResponse& known,
                                     const std::string& name) {
  for (const v1::StrategyInfo& info : known.strategies()) {
    if (info.name() == name) return &info;
  }
  return nullptr;
}

std::vector<std::string> OptionNames(const v1::StrategyInfo& info) {
  std::vector<std::string> names;
  for (const v1::OptionInfo& option : info.options()) names.push_back(option.name());
  return names;
}

bool HasOption(const v1::StrategyInfo& info, const std::string& name) {
  for (const v1::OptionInfo& option : info.options()) {
    if (option.name() == name) return true;
  }
  return false;
}

absl::Status UnknownStrategy(const v1::ListStrategiesResponse& known, const std::string& name) {
  std::vector<std::string> names;
  for (const v1::StrategyInfo& info : known.strategies()) names.push_back(info.name());
  return absl::InvalidArgumentError(
      absl::StrFormat("unknown strategy \"%s\"%s (`traverse strategies` lists them)", name,
                      DidYouMean(name, names)));
}

absl::Status CheckOptions(const v1::StrategyInfo& info, const v1::Strategy& strategy) {
  for (const auto& [name, value] : strategy.options()) {
    if (HasOption(info, name)) continue;
    return absl::InvalidArgumentError(absl::StrFormat("%s has no option \"%s\"%s", info.name(),
                                                      name, DidYouMean(name, OptionNames(info))));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::pair<std::string, std::string>> ParseOption(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return absl::InvalidArgumentError(absl::StrFormat("option \"%s\" is not NAME=VALUE", text));
  }
  return std::make_pair(text.substr(0, equals), text.substr(equals + 1));
}

absl::StatusOr<std::vector<StrategySpec>> ParseStrategySpecs(const std::string& text) {
  std::vector<StrategySpec> specs;
  const std::vector<std::string> words = absl::StrSplit(text, ',');
  for (const std::string& word : words) {
    const std::vector<std::string> parts = absl::StrSplit(word, ':');
    if (parts.front().empty())
      return absl::InvalidArgumentError(absl::StrFormat("\"%s\" does not name a strategy", text));
    StrategySpec spec;
    spec.label = word;
    spec.strategy.set_name(parts.front());
    for (size_t i = 1; i < parts.size(); ++i) {
      // A switch named without a value is turned on.
      const bool has_value = parts[i].empty() || absl::StrContains(parts[i], '=');
      const auto option = ParseOption(has_value ? parts[i] : absl::StrCat(parts[i], "=true"));
      if (!option.ok()) return option.status();
      (*spec.strategy.mutable_options())[option->first] = option->second;
    }
    specs.push_back(std::move(spec));
  }
  return specs;
}

absl::Status ResolveStrategies(const v1::ListStrategiesResponse& known,
                               absl::Span<const std::pair<std::string, std::string>> options,
                               std::vector<StrategySpec>& specs) {
  std::vector<bool> used(options.size());
  std::vector<std::string> all_names;
  for (StrategySpec& spec : specs) {
    const v1::StrategyInfo* info = FindStrategy(known, spec.strategy.name());
    if (info == nullptr) return UnknownStrategy(known, spec.strategy.name());
    if (absl::Status status = CheckOptions(*info, spec.strategy); !status.ok()) return status;
    const std::vector<std::string> names = OptionNames(*info);
    all_names.insert(all_names.end(), names.begin(), names.end());

    const v1::Strategy given = spec.strategy;
    for (size_t i = 0; i < options.size(); ++i) {
      if (!HasOption(*info, options[i].first)) continue;
      used[i] = true;
      if (given.options().contains(options[i].first)) continue;
      (*spec.strategy.mutable_options())[options[i].first] = options[i].second;
    }
  }
  for (size_t i = 0; i < options.size(); ++i) {
    if (used[i]) continue;
    return absl::InvalidArgumentError(
        absl::StrFormat("--option=%s: none of the strategies has this option%s", options[i].first,
                        DidYouMean(options[i].first, all_names)));
  }
  return absl::OkStatus();
}

}  // namespace traverse::cli
