#include "client/gcode/plan/policy.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

namespace traverse::gcode {
namespace {

constexpr std::string_view kPolicyNames[] = {"safe", "balanced", "free", "fast"};
constexpr std::string_view kCrossingsNames[] = {"keep", "fewer", "any"};

// The value that has its name in `names`, which are those of all values.
template <typename Value, size_t n>
std::optional<Value> ValueOfName(const std::string_view (&names)[n], std::string_view name) {
  const auto* const known = std::ranges::find(names, name);
  if (known == std::end(names)) return std::nullopt;
  return static_cast<Value>(known - std::begin(names));
}

struct AllowanceName {
  std::string_view name;
  bool Allowance::*flag;
};

constexpr AllowanceName kAllowances[] = {
    {"infill_order", &Allowance::infill_order},
    {"wall_order", &Allowance::wall_order},
    {"fan_order", &Allowance::fan_order},
    {"wipes", &Allowance::wipes},
    {"hidden_retractions", &Allowance::hidden_retractions},
    {"inner_detours", &Allowance::inner_detours},
};

}  // namespace

std::optional<Policy> PolicyOfName(std::string_view name) {
  return ValueOfName<Policy>(kPolicyNames, name);
}

std::string_view PolicyName(Policy policy) { return kPolicyNames[static_cast<size_t>(policy)]; }

Allowance AllowedUnder(Policy policy, Allowance allow) {
  const bool fast = policy == Policy::kFast;
  allow.wipes = allow.wipes || fast;
  allow.inner_detours = allow.inner_detours || fast;
  allow.hidden_retractions = allow.hidden_retractions || allow.inner_detours;
  return allow;
}

std::optional<Allowance> AllowanceOfNames(std::string_view names) {
  Allowance allow;
  while (!names.empty()) {
    const size_t end = std::min(names.find(','), names.size());
    const std::string_view word = names.substr(0, end);
    const auto* const known = std::ranges::find(kAllowances, word, &AllowanceName::name);
    if (known == std::end(kAllowances) || end + 1 == names.size()) return std::nullopt;
    allow.*known->flag = true;
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  return allow;
}

std::string AllowanceNames(const Allowance& allow) {
  std::string names;
  for (const AllowanceName& it : kAllowances) {
    if (!(allow.*it.flag)) continue;
    if (!names.empty()) names += '+';
    names += it.name;
  }
  return names;
}

std::optional<Crossings> CrossingsOfName(std::string_view name) {
  return ValueOfName<Crossings>(kCrossingsNames, name);
}

}  // namespace traverse::gcode
