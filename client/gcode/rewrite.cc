#include "client/gcode/rewrite.h"

#include <utility>

#include "absl/strings/str_format.h"
#include "client/gcode/gcode_out.h"
#include "client/gcode/layer_choice.h"
#include "client/gcode/verify/verifier.h"

namespace traverse {
namespace gcode {
namespace {

std::string Minutes(double seconds) {
  const auto whole = static_cast<int64_t>(seconds + 0.5);
  if (whole < 3600) return absl::StrFormat("%d:%02d", whole / 60, whole % 60);
  return absl::StrFormat("%d:%02d:%02d", whole / 3600, whole % 3600 / 60, whole % 60);
}

double Percent(double before, double after) {
  return before > 0 ? 100 * (after - before) / before : 0;
}

// Where the head of the file ends: its comments, with blank lines between them.
Offset EndOfHead(std::string_view text) {
  Offset end = 0;
  for (Offset next = 0; next < text.size();) {
    const Line line = LineAt(text, next);
    next = line.next;
    const std::string_view content = line.Text(text);
    if (content.empty()) continue;
    if (content[0] != ';') break;
    end = line.next;
  }
  return end;
}

// The part before the first path with the line added, in place of an earlier one.
std::string HeadWithLine(const GcodeFile& file, const std::string& added) {
  const std::string_view head = std::string_view(file.text).substr(0, file.blocks.front().begin);
  const Offset end = EndOfHead(head);
  const size_t first_end = file.text.find('\n');
  const bool crlf = first_end > 0 && file.text[first_end - 1] == '\r';
  std::string out;
  for (Offset next = 0; next < end;) {
    const Line line = LineAt(head, next);
    next = line.next;
    const bool ours = line.Text(head).substr(0, kOptimisedMark.size()) == kOptimisedMark;
    if (!ours) out.append(line.Raw(head));
  }
  out += added + (crlf ? "\r\n" : "\n");
  out.append(head.substr(end));
  return out;
}

// The end script goes on from where the extruder's register is.
std::string Foot(const GcodeFile& file, const ChosenLayers& chosen) {
  std::string foot;
  GcodeOut out(file, chosen.behind, foot);
  const Block& last = file.blocks.back();
  const PartStart behind = StartBehind(file, last);
  out.Copy(last.end, static_cast<Offset>(file.text.size()), behind, behind, false);
  return foot;
}

std::string AddedLine(const GcodeRewrite& rewrite, const RewriteOptions& options) {
  return absl::StrFormat("%s %s, policy %s: %s", kOptimisedMark, options.version,
                         PolicyName(options.policy), DescribeRewrite(rewrite));
}

std::string NewText(const GcodeFile& file, const ChosenLayers& chosen, const std::string& added) {
  std::string text = HeadWithLine(file, added);
  text.reserve(file.text.size() + file.text.size() / 16);
  chosen.AppendTo(file, text);
  text += Foot(file, chosen);
  return text;
}

}  // namespace
}  // namespace gcode

std::string DescribeRewrite(const GcodeRewrite& rewrite) {
  const gcode::PrintTotals& before = rewrite.before;
  const gcode::PrintTotals& after = rewrite.after;
  return absl::StrFormat(
      "travel %.2f -> %.2f m (%+.1f %%), retractions %d -> %d, visible walls crossed %d -> %d, "
      "estimated print time %s -> %s (%+.2f %%)",
      before.travel_mm / 1000, after.travel_mm / 1000,
      gcode::Percent(before.travel_mm, after.travel_mm), before.retractions, after.retractions,
      before.crossings, after.crossings, gcode::Minutes(before.seconds),
      gcode::Minutes(after.seconds), gcode::Percent(before.seconds, after.seconds));
}

absl::StatusOr<GcodeRewrite> RewriteGcode(const GcodeFile& file,
                                          const std::vector<gcode::FileOrder>& tries,
                                          const RewriteOptions& options) {
  GcodeRewrite rewrite;
  rewrite.layers = static_cast<int64_t>(file.layers.size());
  gcode::ChosenLayers chosen = gcode::ChooseLayers(file, tries, options.policy, options.threads);
  rewrite.before = gcode::Sum(chosen.given);
  rewrite.after = gcode::Sum(chosen.totals);
  rewrite.layers_changed = chosen.changed;
  if (chosen.changed == 0 || rewrite.after.seconds > rewrite.before.seconds) {
    rewrite.after = rewrite.before;
    rewrite.layers_changed = 0;
    rewrite.text = file.text;
    return rewrite;
  }
  rewrite.text = gcode::NewText(file, chosen, gcode::AddedLine(rewrite, options));
  chosen = {};  // its texts are in there
  const absl::Status same =
      VerifyGcode(file.text, file.name, rewrite.text, file.name + " as optimised");
  if (!same.ok()) return same;
  return rewrite;
}

}  // namespace traverse
