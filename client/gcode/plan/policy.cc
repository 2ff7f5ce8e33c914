#include "client/gcode/plan/policy.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

namespace traverse::gcode {

std::optional<Policy> PolicyOfName(std::string_view name) {
  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree, Policy::kFast}) {
    if (PolicyName(policy) == name) return policy;
  }
  return std::nullopt;
}

std::string_view PolicyName(Policy policy) {
  switch (policy) {
    case Policy::kSafe:
      return "safe";
    case Policy::kBalanced:
      return "balanced";
    case Policy::kFree:
      return "free";
    case Policy::kFast:
      return "fast";
  }
  return "";
}

namespace {

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
    const auto* known = std::find_if(std::begin(kAllowances), std::end(kAllowances),
                                     [word](const AllowanceName& it) { return it.name == word; });
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
  for (const Crossings crossings : {Crossings::kKeep, Crossings::kFewer, Crossings::kAny}) {
    if (CrossingsName(crossings) == name) return crossings;
  }
  return std::nullopt;
}

std::string_view CrossingsName(Crossings crossings) {
  switch (crossings) {
    case Crossings::kKeep:
      return "keep";
    case Crossings::kFewer:
      return "fewer";
    case Crossings::kAny:
      return "any";
  }
  return "";
}

}  // namespace traverse::gcode
