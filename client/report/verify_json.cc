#include "client/report/verify_json.h"

#include <set>

#include "client/files/json.h"

namespace traverse::report {
namespace {

Json LineOrNull(const VerifyBreak& found) {
  Json json;
  json["original_line"] = found.original_line;
  json["optimised_line"] = found.optimised_line;
  json["layer"] = found.layer < 0 ? Json() : Json(found.layer + 1);
  json["message"] = found.message;
  return json;
}

Json RuleJson(const VerifyReport& report, VerifyRule rule) {
  Json json;
  json["rule"] = std::string(VerifyRuleName(rule));
  json["states"] = std::string(VerifyRuleText(rule));
  json["breaks"] = report.counts[static_cast<size_t>(rule)];
  std::set<int64_t> layers;
  const VerifyBreak* first = nullptr;
  for (const VerifyBreak& found : report.breaks) {
    if (found.rule != rule) continue;
    if (first == nullptr) first = &found;
    if (found.layer >= 0) layers.insert(found.layer + 1);
  }
  json["layers"] = JsonArray(layers.begin(), layers.end());
  json["first"] = first == nullptr ? Json() : LineOrNull(*first);
  return json;
}

Json AllowJson(const VerifyPermissions& permissions) {
  JsonArray names;
  if (permissions.infill_order) names.push_back("infill_order");
  if (permissions.wall_order) names.push_back("wall_order");
  if (permissions.fan_order) names.push_back("fan_order");
  if (permissions.wipes) names.push_back("wipes");
  if (permissions.hidden_retractions) names.push_back("hidden_retractions");
  if (permissions.inner_detours) names.push_back("inner_detours");
  return names;
}

}  // namespace

std::string VerifyJson(const std::string& original, const std::string& optimised,
                       const VerifyReport& report) {
  const std::string permissions = DescribePermissions(report.permissions);
  std::string text =
      "{\"original\": " + JsonText(original) + ", \"optimised\": " + JsonText(optimised) +
      ",\n \"same\": " + (report.ok() ? "true" : "false") +
      ", \"policy\": " + JsonText(permissions.substr(0, permissions.find(','))) +
      ", \"allow\": " + JsonText(AllowJson(report.permissions)) + ",\n \"rules\": [\n";
  for (size_t rule = 0; rule < static_cast<size_t>(VerifyRule::kCount); ++rule) {
    if (rule > 0) text += ",\n";
    text += "  " + JsonText(RuleJson(report, static_cast<VerifyRule>(rule)));
  }
  return text + "\n ]}\n";
}

}  // namespace traverse::report
