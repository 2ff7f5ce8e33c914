#include "client/gcode/write/true_progress.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "client/gcode/measure/layer_meter.h"

namespace traverse::gcode {
namespace {

constexpr double kMostOff = 0.01;  // of the print time

// A line of progress, and the share of the print time that is over there.
struct ProgressMoment {
  size_t begin = 0;
  size_t end = 0;
  double share = 0;
  bool in_print = false;  // between the first deposit and the last one
};

// All of `text`.
struct ProgressMoments {
  std::vector<ProgressMoment> lines;
  double seconds = 0;
  double deposited_seconds = 0;  // up to the last deposit
};

ProgressMoments MomentsOf(const GcodeFile& file, std::string_view text) {
  ProgressMoments found;
  bool begun = false;
  size_t printed = 0;  // lines before the last deposit
  bool deposits = false;
  const auto visit = [&](const Step& step, double seconds) {
    if (std::exchange(deposits, false)) {
      found.deposited_seconds = seconds;
      printed = found.lines.size();
    }
    deposits = step.kind == StepKind::kExtrude;
    begun = begun || deposits;
    if (step.kind != StepKind::kProgress) return;
    found.lines.push_back({step.line.begin, step.line.next, seconds, begun});
  };
  found.seconds = MeasureMoments(file, text, StartOfFile(file), nullptr, visit);
  if (deposits) {
    found.deposited_seconds = found.seconds;
    printed = found.lines.size();
  }
  for (size_t i = 0; i < found.lines.size(); ++i) {
    found.lines[i].share /= std::max(found.seconds, 1e-9);
    found.lines[i].in_print = found.lines[i].in_print && i < printed;
  }
  return found;
}

// `M73 L4`, `; layer num/total_layer_count: 4/20`.
bool SaysLayer(std::string_view line) {
  const std::string small = absl::AsciiStrToLower(std::string(line));
  return absl::StrContains(small, "layer") ||
         (small.starts_with("m73") && absl::StrContains(small, "l"));
}

// Copies a text with some of its lines of progress elsewhere: where a deposit begins or ends, or
// where such a line was, whichever of the two around its moment is nearer.
class Mover {
 public:
  // `moments`: [line of progress of `text`] when it is true, or unset if it stays.
  Mover(std::string_view text, const ProgressMoments& is,
        const std::vector<std::optional<double>>& moments)
      : text_(text), is_(is), moments_(moments) {
    out_.reserve(text.size());
  }

  // The next step of the text, which begins after `seconds`.
  void Take(const Step& step, double seconds) {
    const bool ends = std::exchange(deposits_, step.kind == StepKind::kExtrude);
    if (step.kind == StepKind::kProgress) {
      if (moments_[seen_]) {
        TakeOut(step.line, seconds);
      } else {
        PassBy(step.line);
      }
      ++seen_;
    } else if (deposits_ || ends || seconds >= is_.deposited_seconds) {
      PutUpTo(step.line.begin, seconds);
    }
  }

  std::string Finish() {
    Copy(text_.size());
    while (next_ < moments_.size()) Put();
    return std::move(out_);
  }

 private:
  void Copy(size_t end) {
    out_.append(text_.substr(copied_, end - copied_));
    copied_ = end;
  }

  void Put() {
    const ProgressMoment& line = is_.lines[next_++];
    out_.append(text_.substr(line.begin, line.end - line.begin));
  }

  void TakeOut(const Line& line, double seconds) {
    PutUpTo(line.begin, seconds);
    Copy(line.begin);
    place_ = copied_ = line.next;
  }

  // Those that are to stand before a line that stays do so at the latest there.
  void PassBy(const Line& line) {
    Copy(line.begin);
    while (next_ < seen_) Put();
    ++next_;
  }

  // Puts those whose moment is over at `here`, or at the place before.
  void PutUpTo(size_t here, double seconds) {
    while (next_ < moments_.size() && moments_[next_] && *moments_[next_] <= seconds) {
      const double moment = *moments_[next_];
      const bool before = place_ > 0 && place_ >= copied_;
      Copy(before && moment - place_seconds_ < seconds - moment ? place_ : here);
      Put();
    }
    place_ = here;
    place_seconds_ = seconds;
  }

  const std::string_view text_;
  const ProgressMoments& is_;
  const std::vector<std::optional<double>>& moments_;
  std::string out_;
  size_t copied_ = 0;      // of the text
  size_t next_ = 0;        // line to put
  size_t seen_ = 0;        // lines that have been passed
  bool deposits_ = false;  // the last step
  size_t place_ = 0;       // the last one where a line may stand
  double place_seconds_ = 0;
};

}  // namespace

std::optional<std::string> WithTrueProgress(const GcodeFile& file, std::string_view text) {
  if (file.progress.empty()) return std::nullopt;
  const ProgressMoments was = MomentsOf(file, file.text);
  const ProgressMoments is = MomentsOf(file, text);
  if (was.lines.size() != is.lines.size()) return std::nullopt;
  std::vector<std::optional<double>> moments(is.lines.size());
  bool any = false;
  for (size_t i = 0; i < moments.size(); ++i) {
    const ProgressMoment& line = is.lines[i];
    if (!line.in_print || std::abs(line.share - was.lines[i].share) <= kMostOff ||
        SaysLayer(text.substr(line.begin, line.end - line.begin))) {
      continue;
    }
    moments[i] = std::min(was.lines[i].share * is.seconds, is.deposited_seconds);
    any = true;
  }
  if (!any) return std::nullopt;
  Mover mover(text, is, moments);
  MeasureMoments(file, text, StartOfFile(file), nullptr,
                 [&mover](const Step& step, double seconds) { mover.Take(step, seconds); });
  return mover.Finish();
}

}  // namespace traverse::gcode
