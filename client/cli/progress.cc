#include "client/cli/progress.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "client/cli/terminal.h"
#include "client/report/numbers.h"

namespace traverse::cli {
namespace {

constexpr absl::Duration kBarInterval = absl::Milliseconds(100);
constexpr absl::Duration kLineInterval = absl::Seconds(5);

// Of its work, after which a search tells how long it takes, behind the first layer.
constexpr double kTellingShare = 0.1;

// Returns to the first column and clears the line.
constexpr char kClearLine[] = "\r\x1b[K";

}  // namespace

Progress::Style Progress::StyleFor(bool quiet) {
  if (quiet) return Style::kNone;
  return IsTerminal(stderr) ? Style::kBar : Style::kLines;
}

Progress::Progress(Style style, std::string label, SearchWork work)
    : style_(style), label_(std::move(label)), work_(std::move(work)), began_(absl::Now()) {}

Progress::~Progress() {
  if (bar_drawn_) Print(stderr, kClearLine);
}

void Progress::Take(const v1::LayerResult& layer) { Take(layer, absl::Now() - began_); }

void Progress::Take(const v1::LayerResult& layer, absl::Duration elapsed) {
  ++done_;
  done_work_ += work_.layers[layer.index()];
  if (done_ == 1) {
    first_seconds_ = absl::ToDoubleSeconds(elapsed);
    first_work_ = done_work_;
  }
  given_mm_ += layer.given().total_mm() + layer.cleaning_given_mm();
  travel_mm_ += layer.travel().total_mm() + layer.cleaning_mm();
  const bool bar = style_ == Style::kBar;
  if (style_ == Style::kNone || elapsed - shown_ < (bar ? kBarInterval : kLineInterval)) return;
  shown_ = elapsed;
  const std::string text = Text(elapsed, TerminalWidth(stderr) - 1);
  Print(stderr, bar ? kClearLine + text : text + "\n");
  bar_drawn_ = bar;
}

// Of the search, and of what follows; unset if too little is done to tell. All layers are searched
// side by side before the first one is done, so only what is done since then tells how fast the
// others will be.
std::optional<double> Progress::SecondsLeft(double elapsed_seconds) const {
  const double all = std::accumulate(work_.layers.begin(), work_.layers.end(), 0.0);
  const double since = done_work_ - first_work_;
  if (since <= 0 || since < kTellingShare * all) return std::nullopt;
  const double left = (all - done_work_) * (elapsed_seconds - first_seconds_) / since;
  return std::max(left, 0.0) + (elapsed_seconds + left) * work_.stages_behind +
         work_.seconds_behind;
}

std::string Progress::Text(absl::Duration elapsed, int width) const {
  const uint64_t layers = work_.layers.size();
  std::string out = absl::StrFormat("%d/%d layers", done_, layers);
  if (given_mm_ > 0) {
    absl::StrAppendFormat(&out, ", travel %s", report::Change(given_mm_, travel_mm_));
  }
  const std::optional<double> left = SecondsLeft(absl::ToDoubleSeconds(elapsed));
  if (done_ > 0 && done_ < layers && left) {
    absl::StrAppendFormat(&out, ", %s left", report::Duration(*left));
  }
  if (style_ != Style::kBar) return absl::StrFormat("%s: %s", label_, out);

  const int used = static_cast<int>(label_.size() + out.size()) + 5;  // brackets and blanks
  const int cells = std::min(40, width - used);
  std::string bar;
  if (cells >= 5) {
    const int full =
        static_cast<int>(done_ * static_cast<uint64_t>(cells) / std::max<uint64_t>(1, layers));
    bar = absl::StrFormat("[%s%s] ", std::string(static_cast<size_t>(full), '#'),
                          std::string(static_cast<size_t>(cells - full), '-'));
  }
  return absl::StrFormat("%s  %s%s", label_, bar, out)
      .substr(0, static_cast<size_t>(std::max(0, width)));
}

}  // namespace traverse::cli
