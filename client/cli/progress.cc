#include "client/cli/progress.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/cli/terminal.h"
#include "client/report/numbers.h"

namespace traverse::cli {
namespace {

constexpr absl::Duration kBarInterval = absl::Milliseconds(100);
constexpr absl::Duration kLineInterval = absl::Seconds(5);

// Of its work, after which a search tells how long it takes: the first layers that are done are the
// smallest ones, and others are half done by then.
constexpr double kTellingShare = 0.1;

// Returns to the first column and clears the line.
constexpr char kClearLine[] = "\r\x1b[K";

}  // namespace

Progress::Style Progress::StyleFor(bool quiet) {
  if (quiet) return Style::kNone;
  return IsTerminal(stderr) ? Style::kBar : Style::kLines;
}

Progress::Progress(Style style, std::string label, uint64_t layers)
    : style_(style),
      label_(std::move(label)),
      layers_(layers),
      began_(absl::Now()),
      shown_(began_) {}

Progress::~Progress() {
  if (bar_drawn_) Print(stderr, kClearLine);
}

void Progress::Take(const v1::LayerResult& layer) {
  ++done_;
  done_work_ += WorkOf(layer.index());
  given_mm_ += layer.given().total_mm() + layer.cleaning_given_mm();
  travel_mm_ += layer.travel().total_mm() + layer.cleaning_mm();
  const absl::Time now = absl::Now();
  const bool bar = style_ == Style::kBar;
  if (style_ == Style::kNone || now - shown_ < (bar ? kBarInterval : kLineInterval)) return;
  shown_ = now;
  const std::string text = Text(now - began_, TerminalWidth(stderr) - 1);
  Print(stderr, bar ? kClearLine + text : text + "\n");
  bar_drawn_ = bar;
}

double Progress::WorkOf(uint64_t layer) const {
  return layer < work_.layers.size() ? work_.layers[layer] : 1;
}

// Of this search, and of what follows; unset if too little is done to tell.
std::optional<double> Progress::SecondsLeft(double elapsed_seconds) const {
  double all = 0;
  for (uint64_t layer = 0; layer < layers_; ++layer) all += WorkOf(layer);
  if (done_work_ < kTellingShare * all) return std::nullopt;
  const double whole = elapsed_seconds * all / done_work_;
  return std::max(whole - elapsed_seconds, 0.0) + whole * work_.stages_behind;
}

std::string Progress::Text(absl::Duration elapsed, int width) const {
  std::string out = absl::StrFormat("%d/%d layers", done_, layers_);
  if (given_mm_ > 0) {
    absl::StrAppendFormat(&out, ", travel %s", report::Change(given_mm_, travel_mm_));
  }
  const std::optional<double> left = SecondsLeft(absl::ToDoubleSeconds(elapsed));
  if (done_ > 0 && done_ < layers_ && left) {
    absl::StrAppendFormat(&out, ", %s left", report::Duration(*left));
  }
  if (style_ != Style::kBar) return absl::StrFormat("%s: %s", label_, out);

  const int used = static_cast<int>(label_.size() + out.size()) + 5;  // brackets and blanks
  const int cells = std::min(40, width - used);
  std::string bar;
  if (cells >= 5) {
    const int full =
        static_cast<int>(done_ * static_cast<uint64_t>(cells) / std::max<uint64_t>(1, layers_));
    bar = absl::StrFormat("[%s%s] ", std::string(static_cast<size_t>(full), '#'),
                          std::string(static_cast<size_t>(cells - full), '-'));
  }
  return absl::StrFormat("%s  %s%s", label_, bar, out)
      .substr(0, static_cast<size_t>(std::max(0, width)));
}

}  // namespace traverse::cli
