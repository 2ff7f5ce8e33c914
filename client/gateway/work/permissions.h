// Policies and allowances, in the product's own types and in those of the API.
//
// Rewriting and verifier have types of their own for them, with members of the same names, so that
// what the one may do and what the other accepts stay independent. Both are converted here.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_PERMISSIONS_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_PERMISSIONS_H_

#include <array>
#include <optional>
#include <utility>

#include "traverse/v1/gcode_service.pb.h"

namespace traverse::gateway {

template <typename Policy>
constexpr std::array<std::pair<v1::Policy, Policy>, 4> kPolicies = {{
    {v1::POLICY_SAFE, Policy::kSafe},
    {v1::POLICY_BALANCED, Policy::kBalanced},
    {v1::POLICY_FREE, Policy::kFree},
    {v1::POLICY_FAST, Policy::kFast},
}};

template <typename Policy>
v1::Policy PolicyMessage(Policy policy) {
  for (const auto& [message, own] : kPolicies<Policy>) {
    if (own == policy) return message;
  }
  return v1::POLICY_UNSPECIFIED;
}

// Unset if `message` is unspecified or a number that no policy has.
template <typename Policy>
std::optional<Policy> PolicyFrom(v1::Policy message) {
  for (const auto& [known, own] : kPolicies<Policy>) {
    if (known == message) return own;
  }
  return std::nullopt;
}

// `Allowed`: a struct with a bool for each allowance.
template <typename Allowed>
constexpr std::array<std::pair<v1::Allowance, bool Allowed::*>, 6> kAllowances = {{
    {v1::ALLOWANCE_INFILL_ORDER, &Allowed::infill_order},
    {v1::ALLOWANCE_WALL_ORDER, &Allowed::wall_order},
    {v1::ALLOWANCE_FAN_ORDER, &Allowed::fan_order},
    {v1::ALLOWANCE_WIPES, &Allowed::wipes},
    {v1::ALLOWANCE_HIDDEN_RETRACTIONS, &Allowed::hidden_retractions},
    {v1::ALLOWANCE_INNER_DETOURS, &Allowed::inner_detours},
}};

// False if `allowance` is none that is known.
template <typename Allowed>
bool Allow(v1::Allowance allowance, Allowed& allowed) {
  for (const auto& [known, member] : kAllowances<Allowed>) {
    if (known != allowance) continue;
    allowed.*member = true;
    return true;
  }
  return false;
}

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_PERMISSIONS_H_
