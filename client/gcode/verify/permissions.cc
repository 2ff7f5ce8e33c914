#include "client/gcode/verify/permissions.h"

#include <algorithm>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/gcode/verify/text.h"

namespace traverse {
namespace {

using Policy = VerifyPermissions::Policy;

constexpr std::string_view kPolicyNames[] = {"safe", "balanced", "free", "fast"};

struct Permission {
  std::string_view name;
  bool VerifyPermissions::*flag;
};

constexpr Permission kPermissions[] = {
    {"infill_order", &VerifyPermissions::infill_order},
    {"wall_order", &VerifyPermissions::wall_order},
    {"fan_order", &VerifyPermissions::fan_order},
    {"wipes", &VerifyPermissions::wipes},
    {"hidden_retractions", &VerifyPermissions::hidden_retractions},
    {"inner_detours", &VerifyPermissions::inner_detours},
};

// Takes what stands before the first of `ends` off `text`, and that character too.
std::string_view TakeWord(std::string_view& text, std::string_view ends) {
  const size_t end = std::min(text.find_first_of(ends), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return word;
}

}  // namespace

absl::StatusOr<VerifyPermissions> ParsePermissions(std::string_view policy,
                                                   std::string_view allow) {
  VerifyPermissions permissions;
  const auto* name = std::ranges::find(kPolicyNames, policy);
  if (name == std::end(kPolicyNames)) {
    return absl::InvalidArgumentError(absl::StrCat("no such policy: ", std::string(policy),
                                                   "; there are safe, balanced, free and fast"));
  }
  permissions.policy = static_cast<Policy>(name - std::begin(kPolicyNames));
  while (!allow.empty()) {
    const std::string_view word = TakeWord(allow, ",+");
    const auto* known = std::ranges::find(kPermissions, word, &Permission::name);
    if (known == std::end(kPermissions)) {
      return absl::InvalidArgumentError(absl::StrCat(
          "nothing to allow by the name `", std::string(word),
          "`; there are infill_order, wall_order, fan_order, wipes, hidden_retractions and ",
          "inner_detours"));
    }
    permissions.*known->flag = true;
  }
  return permissions;
}

std::optional<VerifyPermissions> PermissionsInHead(std::string_view text) {
  constexpr std::string_view kPolicy = ", policy ";
  constexpr std::string_view kAllow = " allow ";
  constexpr std::string_view kMaxHidden = " max_hidden_travel ";
  if (text.starts_with(gcode::kMarkOfUtf8)) text.remove_prefix(gcode::kMarkOfUtf8.size());
  while (!text.empty()) {
    std::string_view line = TakeWord(text, "\n");
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
    if (line.empty()) continue;
    if (line[0] != ';') return std::nullopt;
    if (!line.starts_with(kOptimisedMark)) continue;
    const size_t at = line.find(kPolicy);
    if (at == std::string_view::npos) return std::nullopt;
    std::string_view rest = line.substr(at + kPolicy.size());
    std::string_view clause = TakeWord(rest, ":");
    const std::string_view policy = TakeWord(clause, ",");
    std::string_view allow;
    double longest = VerifyPermissions::kUsualHiddenTravelMm;
    while (!clause.empty()) {
      const std::string_view part = TakeWord(clause, ",");
      if (part.starts_with(kAllow)) {
        allow = part.substr(kAllow.size());
      } else if (part.starts_with(kMaxHidden) &&
                 (!absl::SimpleAtod(std::string(part.substr(kMaxHidden.size())), &longest) ||
                  !(longest >= 0 && longest <= VerifyPermissions::kMostHiddenTravelMm))) {
        return std::nullopt;
      }
    }
    absl::StatusOr<VerifyPermissions> read = ParsePermissions(policy, allow);
    if (!read.ok()) return std::nullopt;
    read->max_hidden_travel_mm = longest;
    return *read;
  }
  return std::nullopt;
}

VerifyPermissions PermissionsFor(const std::optional<GivenPermissions>& given,
                                 std::string_view optimised) {
  if (given && !given->policy_as_stated) return given->permissions;
  const VerifyPermissions stated = PermissionsInHead(optimised).value_or(VerifyPermissions{});
  if (!given) return stated;
  VerifyPermissions permissions = given->permissions;
  permissions.policy = stated.policy;
  if (permissions.max_hidden_travel_mm == VerifyPermissions::kUsualHiddenTravelMm) {
    permissions.max_hidden_travel_mm = stated.max_hidden_travel_mm;
  }
  return permissions;
}

std::string DescribePermissions(const VerifyPermissions& permissions) {
  std::string text(kPolicyNames[static_cast<size_t>(permissions.policy)]);
  for (const Permission& permission : kPermissions) {
    if (permissions.*permission.flag) absl::StrAppend(&text, ", ", std::string(permission.name));
  }
  if (permissions.max_hidden_travel_mm != VerifyPermissions::kUsualHiddenTravelMm) {
    absl::StrAppend(&text, ", max_hidden_travel ", permissions.max_hidden_travel_mm);
  }
  return text;
}

}  // namespace traverse
