#include "client/gcode/rewrite.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/files/process_memory.h"
#include "client/files/utf8_mark.h"
#include "client/gcode/barriers.h"
#include "client/gcode/choose/layer_choice.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/stated_progress.h"
#include "client/gcode/text/digest_line.h"
#include "client/gcode/text/text.h"
#include "client/gcode/verify/verifier.h"
#include "client/gcode/write/gcode_out.h"
#include "client/gcode/write/true_progress.h"

namespace traverse {
namespace gcode {
namespace {

// A layer is looked at again so often before it stays as it is, and a file before what is left of
// it does.
constexpr int kRoundsOfLayers = 6;
constexpr int kMostRounds = 24;

std::string Minutes(double seconds) {
  const auto whole = static_cast<int64_t>(seconds + 0.5);
  if (whole < 3600) return absl::StrFormat("%d:%02d", whole / 60, whole % 60);
  return absl::StrFormat("%d:%02d:%02d", whole / 3600, whole % 3600 / 60, whole % 60);
}

double Percent(double before, double after) {
  return before > 0 ? 100 * (after - before) / before : 0;
}

// Where the head of the file ends: its comments, with blank lines between them; in front of a
// picture that something else stands in. The mark of UTF-8 stays in front of whatever it stands in
// front of.
Offset EndOfHead(std::string_view text) {
  Offset end = text.starts_with(kUtf8Mark) ? LineAt(text, 0).next : 0;
  std::optional<Offset> picture;
  for (Offset next = end; next < text.size();) {
    const Line line = LineAt(text, next);
    next = line.next;
    const std::string_view content = TrimBlanks(line.Text(text));
    if (content.empty()) continue;
    if (content[0] != ';') break;
    if (content.starts_with("; thumbnail")) {
      picture.reset();
      if (content.find(" begin") != std::string_view::npos) picture = line.begin;
    }
    end = line.next;
  }
  return picture.value_or(end);
}

// The part before the first path with the line added, in place of an earlier one.
std::string HeadWithLine(const GcodeFile& file, const std::string& added) {
  const std::string_view head = std::string_view(file.text).substr(0, file.blocks.front().begin);
  const Offset end = EndOfHead(head);
  std::string out;
  for (Offset next = 0; next < end;) {
    const Line line = LineAt(head, next);
    next = line.next;
    const bool ours = line.Text(head).substr(0, kOptimisedMark.size()) == kOptimisedMark;
    if (!ours) out.append(line.Raw(head));
  }
  out += added + LineEndOf(file.text);
  out.append(head.substr(end));
  return out;
}

// The end script goes on from where the extruder's register is.
std::string Foot(const GcodeFile& file, const ChosenLayers& chosen) {
  std::string foot;
  GcodeOut out(file, chosen.behind, foot);
  const Block& last = file.blocks.back();
  const PartStart behind = StartBehind(file, last);
  out.Copy({last.end, static_cast<Offset>(file.text.size()), behind, behind});
  return foot;
}

std::string AddedLine(const GcodeRewrite& rewrite, const RewriteOptions& options) {
  const std::string allowed = AllowanceNames(options.allow);
  const double longest = options.allow.max_hidden_travel_mm;
  const std::string hidden =
      longest == kMaxHiddenTravelMm ? "" : absl::StrCat(", max_hidden_travel ", longest);
  return absl::StrFormat("%s %s, policy %s%s%s%s: %s", kOptimisedMark, options.version,
                         PolicyName(options.policy), allowed.empty() ? "" : ", allow ", allowed,
                         hidden, DescribeRewrite(rewrite));
}

std::string NewText(const GcodeFile& file, const ChosenLayers& chosen, const std::string& head) {
  std::string text = head;
  ReserveLarge(text, file.text.size() + file.text.size() / 16);
  chosen.AppendTo(file, text);
  text += Foot(file, chosen);
  return text;
}

// What a person sees who looks at `text`: it is read and measured like any other. There are not two
// of it at a time. Nothing where E is taken otherwise.
absl::StatusOr<std::optional<PrintTotals>> MeasureText(const GcodeFile& file, std::string& text,
                                                       int threads) {
  const absl::StatusOr<std::shared_ptr<GcodeFile>> read =
      ReadGcode(std::move(text), file.name, file.limit);
  if (!read.ok()) return read.status();
  (*read)->profile = file.profile;  // it may know more of the machine than the text says
  std::optional<PrintTotals> totals;
  if (CountAlike(file, **read)) totals = Sum(MeasureLayers(**read, threads));
  text = std::move((*read)->text);
  return totals;
}

// As lines were numbered when the file was read.
std::string Numbered(const GcodeFile& file, std::string text) {
  return file.numbers ? WithLineNumbers(text, *file.numbers) : std::move(text);
}

GcodeRewrite AsItIs(const GcodeFile& file, GcodeRewrite rewrite) {
  rewrite.after = rewrite.before;
  rewrite.forecast.seconds = rewrite.forecast.given_seconds;
  rewrite.rest.chosen = rewrite.rest.given;
  rewrite.first_after = rewrite.first_before;
  rewrite.layers_changed = 0;
  rewrite.orders.assign(file.layers.size(), {});
  rewrite.text = Numbered(file, file.text);
  return rewrite;
}

VerifyOptions AllRules(const GcodeFile& file, const RewriteOptions& options) {
  VerifyOptions verify;
  verify.limit = file.limit;
  verify.permissions = *ParsePermissions(PolicyName(options.policy), AllowanceNames(options.allow));
  verify.permissions->max_hidden_travel_mm = options.allow.max_hidden_travel_mm;
  return verify;
}

// What is not proven, where, and what would do without: "islands rest as long as in the original,
// ... (part.gcode:118); --policy=free asks for no such rest".
std::string Reason(const GcodeFile& file, const VerifyBreak& found) {
  std::string text(VerifyRuleText(found.rule));
  if (found.original_line != 0) {
    absl::StrAppend(&text, " (", file.name, ":", found.original_line, ")");
  }
  return absl::StrCat(text, found.rule == VerifyRule::kRest
                                ? "; --policy=free asks for no such rest"
                                : "; no flag or setting is known that does without");
}

size_t LinesIn(std::string_view text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

// Where the layers of a new text lie in it.
class LayerLines {
 public:
  LayerLines(const GcodeFile& file, const ChosenLayers& chosen, const std::string& head) {
    size_t line = LinesIn(head) + 1;
    for (size_t i = 0; i < chosen.texts.size(); ++i) {
      const LayerText& text = chosen.texts[i];
      begins_.push_back(line);
      begins_.push_back(line += LinesIn(text.travel));
      line += LinesIn(text.paths.empty() ? file.PathsText(file.layers[i]) : text.paths);
    }
  }

  struct Place {
    size_t layer = 0;
    bool travel = false;  // on the way to the layer
    size_t line = 0;      // else of its paths, from 0
  };

  Place Find(size_t line) const {
    // What stands before all layers is on the way to the first one.
    const auto behind = std::upper_bound(begins_.begin() + 1, begins_.end(), line);
    const auto part = static_cast<size_t>(behind - begins_.begin()) - 1;
    const bool travel = part % 2 == 0;
    return {part / 2, travel, travel ? 0 : line - begins_[part]};
  }

 private:
  // [2 * layer] number of the first line of the travel to it; [2 * layer + 1] and of its paths
  std::vector<size_t> begins_;
};

// Writes a file, looks for what breaks a rule of the verifier, rules that out and writes it again,
// until nothing does.
class Rewriter {
 public:
  Rewriter(const GcodeFile& file, const FileOrder& found, const RewriteOptions& options)
      : file_(file), options_(options), chooser_(file, found, options) {}

  absl::StatusOr<GcodeRewrite> Rewrite() {
    for (int round = 0;; ++round) {
      GcodeRewrite rewrite;
      ChosenLayers chosen = chooser_.Choose();
      if (file_.limit.Ended()) return file_.limit.status();
      NoteChoice(chosen, rewrite);
      if (chosen.changed == 0 || rewrite.after.seconds > rewrite.before.seconds) {
        return AsItIs(file_, std::move(rewrite));
      }
      const std::string head = HeadWithLine(file_, AddedLine(rewrite, options_));
      rewrite.text = NewText(file_, chosen, head);
      // A digest of numbered lines stays as it is until they have their numbers.
      if (file_.states_digest && !file_.numbers) RenewDigest(rewrite.text);
      const LayerLines lines(file_, chosen, head);
      chosen.texts = {};  // they are in there
      const std::vector<VerifyBreak> breaks = MakeProgressTrue(rewrite.text);
      if (absl::Status status = file_.limit.status(); !status.ok()) return status;
      if (breaks.empty()) {
        rewrite.orders = std::move(chosen.orders);
        absl::StatusOr<GcodeRewrite> done = Finish(head, std::move(rewrite));
        if (!done.ok() || !CrossesMore(*done)) return done;
        // Where walls have no names, what is one is told by its neighbours, and they may change.
        const int64_t more = done->after.crossings - done->before.crossings;
        chooser_.Tighten(round + 1 < kRoundsOfLayers ? more : done->before.crossings + 1);
        continue;
      }
      if (unproven_.empty()) unproven_ = Reason(file_, breaks.front());
      RuleOut(breaks, lines, round);
    }
  }

  double SecondsSavedByFast() const { return chooser_.SecondsSavedByFast(); }

 private:
  // Moves lines of progress in `text` to where they are true, unless that cannot be proven. Returns
  // what breaks a rule: such lines only where nothing else does, for they may still be moved.
  std::vector<VerifyBreak> MakeProgressTrue(std::string& text) const {
    std::vector<VerifyBreak> breaks = Breaks(text);
    const auto others = std::stable_partition(
        breaks.begin(), breaks.end(),
        [](const VerifyBreak& found) { return found.rule != VerifyRule::kProgress; });
    if (others != breaks.begin()) {
      breaks.erase(others, breaks.end());
      return breaks;
    }
    std::optional<std::string> moved = WithTrueProgress(file_, text);
    if (!moved) return breaks;
    if (file_.states_digest && !file_.numbers) RenewDigest(*moved);
    if (!Breaks(*moved).empty()) return breaks;
    text = *std::move(moved);
    return {};
  }

  std::vector<VerifyBreak> Breaks(const std::string& text) const {
    return CheckGcode(file_.text, file_.name, text, file_.name + " as optimised",
                      AllRules(file_, options_))
        .breaks;
  }

  void NoteChoice(const ChosenLayers& chosen, GcodeRewrite& rewrite) const {
    rewrite.layers = static_cast<int64_t>(file_.layers.size());
    rewrite.before = Sum(chosen.given);
    rewrite.after = Sum(chosen.totals);
    rewrite.layers_changed = chosen.changed;
    rewrite.forecast = chosen.forecast;
    rewrite.rest = chosen.rest;
    if (!chosen.given.empty()) {
      rewrite.first_before = chosen.given.front();
      rewrite.first_after = chosen.totals.front();
    }
    for (size_t layer = 0; layer < file_.layers.size(); ++layer) {
      if (chooser_.IsGivenUp(layer)) ++rewrite.layers_unproven;
    }
    if (rewrite.layers_unproven > 0) rewrite.unproven = unproven_;
    for (const Layer& layer : file_.layers) {
      if (layer.fault == nullptr || rewrite.layers_unclear++ > 0) continue;
      rewrite.unclear = absl::StrCat(file_.Place(layer.fault_at), ": ", layer.fault);
    }
    rewrite.layers_blocked = static_cast<int64_t>(chosen.blocked.size());
    if (!chosen.blocked.empty()) {
      const Layer& first = file_.layers[chosen.blocked.front()];
      rewrite.blocked = file_.Place(file_.blocks[first.first_block].begin);
    }
    rewrite.odd_lines = DescribeOddLines(file_);
  }

  absl::StatusOr<GcodeRewrite> Finish(const std::string& head, GcodeRewrite rewrite) const {
    const absl::StatusOr<std::optional<PrintTotals>> after =
        MeasureText(file_, rewrite.text, options_.threads);
    if (!after.ok()) return after.status();
    if (!after->has_value()) {
      rewrite.layers_unproven = rewrite.layers_changed;
      rewrite.unproven =
          absl::StrCat("E counts as before: neither M82 nor M83 says how in ", file_.name,
                       ", and its words in another order would be taken otherwise; either of them "
                       "in the slicer's start G-code says it");
      return AsItIs(file_, std::move(rewrite));
    }
    rewrite.after = **after;
    if (rewrite.after.seconds > rewrite.before.seconds) return AsItIs(file_, std::move(rewrite));
    rewrite.text.replace(0, head.size(), HeadWithLine(file_, AddedLine(rewrite, options_)));
    rewrite.text = Numbered(file_, std::move(rewrite.text));
    if (file_.states_digest) RenewDigest(rewrite.text);
    return rewrite;
  }

  bool CrossesMore(const GcodeRewrite& rewrite) const {
    return options_.crossings != Crossings::kAny &&
           rewrite.after.crossings > rewrite.before.crossings;
  }

  // At the latest in round kMostRounds nothing is left but the file as it is.
  void RuleOut(const std::vector<VerifyBreak>& breaks, const LayerLines& lines, int round) {
    bool any = false;
    for (const VerifyBreak& found : breaks) {
      const LayerLines::Place at = lines.Find(found.optimised_line);
      const bool other_print = found.rule == VerifyRule::kSamePrint;
      if (round >= kRoundsOfLayers) {
        any |= other_print ? RuleOutFrom(at.layer) : RuleOutAround(at.layer);
      } else if (other_print) {
        any |= chooser_.RuleOutStarts(at.layer) || RuleOutAround(at.layer);
      } else {
        any |= RuleOutOrder(found, at, lines) || RuleOut(found.rule, at) || RuleOutAround(at.layer);
      }
    }
    if (!any || round + 1 >= kMostRounds) RuleOutFrom(0);
  }

  // That one path comes before another one of its layer.
  bool RuleOutOrder(const VerifyBreak& found, const LayerLines::Place& at,
                    const LayerLines& lines) {
    if (found.before_line == 0) return false;
    const LayerLines::Place before = lines.Find(found.before_line);
    return !at.travel && !before.travel && at.layer == before.layer &&
           chooser_.RuleOutOrder(at.layer, at.line, before.line);
  }

  bool RuleOut(VerifyRule rule, const LayerLines::Place& at) {
    if (at.travel || rule == VerifyRule::kRest) return chooser_.RuleOutTravel(at.layer);
    const bool of_path = rule == VerifyRule::kWholePaths || rule == VerifyRule::kDirection ||
                         rule == VerifyRule::kSeam || rule == VerifyRule::kPathEnds;
    return (of_path && chooser_.RuleOutPath(at.layer, at.line)) ||
           chooser_.RuleOutLink(at.layer, at.line);
  }

  bool RuleOutAround(size_t layer) {
    if (chooser_.RuleOutAll(layer)) return true;
    // It is as in the file: what is wrong with it comes from the layers beside it.
    const bool before = layer > 0 && chooser_.RuleOutAll(layer - 1);
    const bool behind = layer + 1 < file_.layers.size() && chooser_.RuleOutAll(layer + 1);
    return before || behind;
  }

  bool RuleOutFrom(size_t layer) {
    bool any = false;
    for (; layer < file_.layers.size(); ++layer) any |= chooser_.RuleOutAll(layer);
    return any;
  }

  const GcodeFile& file_;
  const RewriteOptions& options_;
  LayerChooser chooser_;
  std::string unproven_;  // what was found first
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

std::string DescribeRest(const GcodeRewrite& rewrite) {
  const gcode::RestTotals& rest = rewrite.rest;
  if (!rest.given || !rest.chosen) return "";
  const std::string least = absl::StrFormat("least rest of an island %.1f -> %.1f s",
                                            rest.given->seconds, rest.chosen->seconds);
  if (rest.required_seconds <= 0) return least;
  return absl::StrFormat("%s (%.4g s are enough)", least, rest.required_seconds);
}

std::string DescribeFast(const GcodeRewrite& rewrite) {
  constexpr double kWorthSaying = 0.005;  // of the print time
  const double before = rewrite.before.seconds;
  const double saved = before - rewrite.after.seconds;
  if (rewrite.fast_seconds - saved <= kWorthSaying * before) return "";
  return absl::StrFormat("--policy=fast would save about %.*f %% of the print time (%s)",
                         rewrite.fast_seconds < 0.1 * before ? 1 : 0,
                         100 * rewrite.fast_seconds / before, gcode::Minutes(rewrite.fast_seconds));
}

std::vector<std::string> DescribeLeft(const GcodeRewrite& rewrite) {
  std::vector<std::string> left;
  const auto note = [&left](int64_t count, const char* one, const char* more,
                            const std::string& why) {
    if (count > 0) left.push_back(absl::StrCat(count, " ", count == 1 ? one : more, why));
  };
  note(rewrite.layers_unproven, "layer stays", "layers stay",
       absl::StrCat(" as sliced, because for no faster order could it be proven that ",
                    rewrite.unproven));
  note(rewrite.layers_unclear, "layer stays", "layers stay",
       absl::StrCat(" as sliced, because machines read a line differently: ", rewrite.unclear));
  note(rewrite.layers_blocked, "layer keeps", "layers keep",
       absl::StrCat(" travel that could be shorter, because something finished that stands higher "
                    "is in the way of the head: ",
                    rewrite.blocked, "; objects farther apart in the slicer leave it more room"));
  left.insert(left.end(), rewrite.odd_lines.begin(), rewrite.odd_lines.end());
  left.insert(left.end(), rewrite.barriers.begin(), rewrite.barriers.end());
  return left;
}

absl::StatusOr<GcodeRewrite> RewriteGcode(const GcodeFile& file, const gcode::FileOrder& found,
                                          const RewriteOptions& options) {
  gcode::Rewriter rewriter(file, found, options);
  absl::StatusOr<GcodeRewrite> rewrite = rewriter.Rewrite();
  if (rewrite.ok() && options.forecast_fast && options.policy != gcode::Policy::kFast) {
    rewrite->fast_seconds = rewriter.SecondsSavedByFast();
  }
  if (!rewrite.ok() || rewrite->layers_changed == rewrite->layers) return rewrite;
  std::vector<bool> left;
  for (const gcode::LayerOrder& order : rewrite->orders) left.push_back(order.empty());
  rewrite->barriers = DescribeBarriers(file, options.policy, options.allow, left);
  for (std::string& fault : DescribeProgressFaults(file)) {
    rewrite->barriers.push_back(std::move(fault));
  }
  return rewrite;
}

}  // namespace traverse
