#include "client/gcode/rewrite.h"

#include <memory>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/verify/verifier.h"
#include "client/gcode/write/gcode_out.h"
#include "client/gcode/write/layer_choice.h"

namespace traverse {
namespace gcode {
namespace {

// The rules that no file is written against; `verify` has them all.
constexpr uint32_t kHeldRules = RuleBit(VerifyRule::kSamePrint);

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

std::string NewText(const GcodeFile& file, const ChosenLayers& chosen, const std::string& head) {
  std::string text = head;
  text.reserve(file.text.size() + file.text.size() / 16);
  chosen.AppendTo(file, text);
  text += Foot(file, chosen);
  return text;
}

// What a person sees who looks at the text: it is read and measured like any other.
absl::StatusOr<PrintTotals> MeasureText(const GcodeFile& file, std::string text, int threads) {
  const absl::StatusOr<std::shared_ptr<GcodeFile>> read = ReadGcode(std::move(text), file.name);
  if (!read.ok()) return read.status();
  return Sum(MeasureLayers(**read, threads));
}

GcodeRewrite AsItIs(const GcodeFile& file, GcodeRewrite rewrite) {
  rewrite.after = rewrite.before;
  rewrite.first_after = rewrite.first_before;
  rewrite.layers_changed = 0;
  rewrite.text = file.text;
  return rewrite;
}

absl::StatusOr<GcodeRewrite> RewriteOnce(const GcodeFile& file, const std::vector<FileOrder>& tries,
                                         const RewriteOptions& options) {
  GcodeRewrite rewrite;
  rewrite.layers = static_cast<int64_t>(file.layers.size());
  ChosenLayers chosen =
      ChooseLayers(file, tries, {options.policy, options.crossings, options.threads});
  rewrite.before = Sum(chosen.given);
  rewrite.after = Sum(chosen.totals);
  rewrite.layers_changed = chosen.changed;
  if (!chosen.given.empty()) {
    rewrite.first_before = chosen.given.front();
    rewrite.first_after = chosen.totals.front();
  }
  if (chosen.changed == 0 || rewrite.after.seconds > rewrite.before.seconds) {
    return AsItIs(file, std::move(rewrite));
  }
  const std::string head = HeadWithLine(file, AddedLine(rewrite, options));
  rewrite.text = NewText(file, chosen, head);
  chosen = {};  // its texts are in there
  VerifyOptions verify;
  verify.rules = kHeldRules;
  const absl::Status same =
      VerifyGcode(file.text, file.name, rewrite.text, file.name + " as optimised", verify);
  if (!same.ok()) return same;
  absl::StatusOr<PrintTotals> after = MeasureText(file, rewrite.text, options.threads);
  if (!after.ok()) return after.status();
  rewrite.after = *after;
  if (rewrite.after.seconds > rewrite.before.seconds) return AsItIs(file, std::move(rewrite));
  rewrite.text.replace(0, head.size(), HeadWithLine(file, AddedLine(rewrite, options)));
  return rewrite;
}

// Finds the layers whose orders cannot be proven, by halves.
class Doubter {
 public:
  Doubter(const GcodeFile& file, const std::vector<FileOrder>& tries, const RewriteOptions& options)
      : file_(file), options_(options), tries_(tries) {}

  const std::vector<FileOrder>& tries() const { return tries_; }
  int64_t taken_out() const { return taken_out_; }

  // Takes the orders of those among layers [begin, end) out of the tries; all of them if that takes
  // too many attempts.
  void TakeOut(size_t begin, size_t end) {
    if (begin == end || (attempts_ > 0 && --attempts_ > 0 && Proven(begin, end))) return;
    if (end - begin == 1 || attempts_ <= 0) {
      for (FileOrder& order : tries_) {
        for (size_t layer = begin; layer < end; ++layer) order[layer].clear();
      }
      taken_out_ += static_cast<int64_t>(end - begin);
      return;
    }
    const size_t middle = begin + (end - begin) / 2;
    TakeOut(begin, middle);
    TakeOut(middle, end);
  }

 private:
  bool Proven(size_t begin, size_t end) const {
    std::vector<FileOrder> only = tries_;
    for (FileOrder& order : only) {
      for (size_t layer = 0; layer < order.size(); ++layer) {
        if (layer < begin || layer >= end) order[layer].clear();
      }
    }
    return RewriteOnce(file_, only, options_).ok();
  }

  // Each is a rewriting of the file.
  static constexpr int kMaxAttempts = 60;

  const GcodeFile& file_;
  const RewriteOptions& options_;
  std::vector<FileOrder> tries_;
  int attempts_ = kMaxAttempts;
  int64_t taken_out_ = 0;
};

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
  absl::StatusOr<GcodeRewrite> rewrite = gcode::RewriteOnce(file, tries, options);
  if (rewrite.ok() || !absl::IsFailedPrecondition(rewrite.status())) return rewrite;
  gcode::Doubter doubter(file, tries, options);
  doubter.TakeOut(0, file.layers.size());
  absl::StatusOr<GcodeRewrite> proven = gcode::RewriteOnce(file, doubter.tries(), options);
  if (!proven.ok()) return rewrite;
  proven->layers_unproven = doubter.taken_out();
  proven->unproven = std::string(rewrite.status().message());
  return proven;
}

}  // namespace traverse
