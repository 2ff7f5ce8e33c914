#include "client/gateway/work/verify_answer.h"

#include <algorithm>
#include <string>

#include "client/gateway/work/permissions.h"

namespace traverse::gateway {
namespace {

void SetBreak(const VerifyBreak& found, v1::VerifyBreak& out) {
  out.set_original_line(static_cast<uint32_t>(found.original_line));
  out.set_optimised_line(static_cast<uint32_t>(found.optimised_line));
  out.set_layer(found.layer < 0 ? 0 : static_cast<uint32_t>(found.layer) + 1);
  out.set_message(found.message);
}

}  // namespace

v1::VerifyResponse VerifyAnswer(const VerifyReport& report) {
  v1::VerifyResponse out;
  out.set_same(report.ok());
  if (!report.ok()) out.set_difference(report.breaks[0].message);
  const VerifyPermissions& permissions = report.permissions;
  out.set_policy(PolicyMessage(permissions.policy));
  for (const auto& [message, member] : kAllowances<VerifyPermissions>) {
    if (permissions.*member) out.add_allow(message);
  }
  for (size_t i = 0; i < report.counts.size(); ++i) {
    const VerifyRule rule = static_cast<VerifyRule>(i);
    v1::VerifyRule& row = *out.add_rules();
    row.set_name(std::string(VerifyRuleName(rule)));
    row.set_states(std::string(VerifyRuleText(rule)));
    row.set_breaks(static_cast<uint32_t>(report.counts[i]));
    const auto first =
        std::find_if(report.breaks.begin(), report.breaks.end(),
                     [rule](const VerifyBreak& found) { return found.rule == rule; });
    if (first != report.breaks.end()) SetBreak(*first, *row.mutable_first());
  }
  return out;
}

}  // namespace traverse::gateway
