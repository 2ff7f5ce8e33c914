#include "engine/strategy/registry.h"

#include <algorithm>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "engine/strategy/auto.h"
#include "engine/strategy/exact.h"
#include "engine/strategy/greedy.h"
#include "engine/strategy/in_ordinary_unit.h"
#include "engine/strategy/ni2opt.h"
#include "engine/strategy/none.h"
#include "engine/strategy/tabu.h"

namespace traverse {

const std::vector<StrategyEntry>& Strategies() {
  static const auto& entries = *new std::vector<StrategyEntry>{
      NoneEntry(), GreedyEntry(), Ni2optEntry(), AutoEntry(), TabuEntry(), ExactEntry()};
  return entries;
}

const std::string& DefaultStrategyName() {
  const auto& entries = Strategies();
  return std::find_if(entries.begin(), entries.end(),
                      [](const StrategyEntry& e) { return e.name == "auto"; })
      ->name;
}

absl::StatusOr<std::unique_ptr<Strategy>> MakeStrategy(
    const std::string& name, const std::map<std::string, std::string>& options) {
  const auto& entries = Strategies();
  const auto entry = std::find_if(entries.begin(), entries.end(),
                                  [&](const StrategyEntry& e) { return e.name == name; });
  if (entry == entries.end()) {
    return absl::InvalidArgumentError(absl::StrCat(
        "name: no strategy \"", name, "\"; there are ",
        absl::StrJoin(entries, ", ",
                      [](std::string* out, const StrategyEntry& e) { out->append(e.name); })));
  }
  absl::StatusOr<StrategyOptions> parsed = StrategyOptions::Parse(entry->options, options);
  if (!parsed.ok()) return parsed.status();
  return InOrdinaryUnit(entry->make(*parsed));
}

}  // namespace traverse
