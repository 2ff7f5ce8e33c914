// Describes a file's result in the log, the metrics, headers and JSON.

#include <google/protobuf/util/json_util.h>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/gateway/api/file_routes.h"
#include "client/gcode/plan/policy.h"

namespace traverse::gateway {
namespace {

std::string OutcomeOf(const absl::Status& status, const v1::RewriteSummary* summary) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return summary != nullptr && summary->layers_changed() == 0 ? "unchanged" : "rewritten";
    case absl::StatusCode::kAlreadyExists:
      return "unchanged";
    case absl::StatusCode::kCancelled:
      return "cancelled";
    case absl::StatusCode::kDeadlineExceeded:
      return "late";
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kFailedPrecondition:
    case absl::StatusCode::kOutOfRange:
    case absl::StatusCode::kUnimplemented:
      return "refused";
    default:
      return "failed";
  }
}

std::string PolicyText(v1::Policy policy) {
  const std::string name = v1::Policy_Name(policy);
  constexpr size_t kPrefix = sizeof("POLICY_") - 1;
  return absl::AsciiStrToLower(name.substr(std::min(kPrefix, name.size())));
}

// Of an archive each plate has a line. A header longer than this is refused by many clients, and a
// line of the log would be as long as the caller likes.
std::string Shortened(const std::string& text) {
  constexpr size_t kMostBytes = 2000;
  if (text.size() <= kMostBytes) return text;
  return text.substr(0, text.rfind(';', kMostBytes)).substr(0, kMostBytes) + "; ...";
}

}  // namespace

void RecordFile(Core& core, const FileRecord& record, const absl::Status& status,
                const v1::RewriteSummary* summary) {
  const std::string outcome = OutcomeOf(status, summary);
  core.metrics.CountFile(outcome);
  if (status.ok() && summary != nullptr) core.metrics.CountSaved(*summary);
  JobLog::Fields fields = {{"route", record.route},
                           {"caller", record.caller},
                           {"peer", record.peer},
                           {"name", record.name},
                           {"bytes", absl::StrCat(record.bytes)},
                           {"seconds", absl::StrFormat("%.3f", record.seconds)},
                           {"outcome", outcome}};
  if (!status.ok()) fields.emplace_back("message", std::string(status.message()));
  if (status.ok() && summary != nullptr) fields.emplace_back("message", Shortened(summary->text()));
  core.files.log->Event(status.ok() ? JobLog::Level::kInfo : JobLog::Level::kWarning, "file",
                        fields);
}

std::vector<std::pair<std::string, std::string>> SummaryHeaders(const v1::RewriteSummary& summary) {
  const auto mm = [](double value) { return absl::StrFormat("%.2f", value); };
  return {
      {"Traverse-Policy", PolicyText(summary.policy())},
      {"Traverse-Verified", summary.verified() ? "true" : "false"},
      {"Traverse-Layers", absl::StrCat(summary.layers())},
      {"Traverse-Layers-Changed", absl::StrCat(summary.layers_changed())},
      {"Traverse-Travel-Given-Mm", mm(summary.given().travel_mm())},
      {"Traverse-Travel-Mm", mm(summary.written().travel_mm())},
      {"Traverse-Retractions-Given", absl::StrCat(summary.given().retractions())},
      {"Traverse-Retractions", absl::StrCat(summary.written().retractions())},
      {"Traverse-Crossings-Given", absl::StrCat(summary.given().crossings())},
      {"Traverse-Crossings", absl::StrCat(summary.written().crossings())},
      {"Traverse-Print-Seconds-Given", mm(summary.given().print_seconds())},
      {"Traverse-Print-Seconds", mm(summary.written().print_seconds())},
      {"Traverse-Summary", Shortened(summary.text())},
  };
}

std::string MessageJson(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  if (!google::protobuf::util::MessageToJsonString(message, &json, options).ok()) return "{}";
  return json;
}

std::string AttachmentHeader(const std::string& name) {
  std::string plain, escaped;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool simple = absl::ascii_isalnum(byte) || c == '.' || c == '-' || c == '_';
    plain += simple || c == ' ' ? c : '_';
    if (simple) {
      escaped += c;
    } else {
      absl::StrAppendFormat(&escaped, "%%%02X", byte);
    }
  }
  return absl::StrCat("attachment; filename=\"", plain, "\"; filename*=UTF-8''", escaped);
}

}  // namespace traverse::gateway
