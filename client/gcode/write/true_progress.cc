#include "client/gcode/write/true_progress.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
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

// All of `text`, up to the last deposit.
struct ProgressMoments {
  std::vector<ProgressMoment> lines;
  double seconds = 0;
};

ProgressMoments MomentsOf(const GcodeFile& file, std::string_view text) {
  ProgressMoments found;
  bool begun = false;
  size_t printed = 0;  // lines before the last deposit
  bool deposits = false;
  const auto visit = [&](const Step& step, double seconds) {
    if (std::exchange(deposits, false)) {
      found.seconds = seconds;
      printed = found.lines.size();
    }
    deposits = step.kind == StepKind::kExtrude;
    begun = begun || deposits;
    if (step.kind != StepKind::kProgress) return;
    found.lines.push_back({step.line.begin, step.line.next, seconds, begun});
  };
  MeasureMoments(file, text, StartOfFile(file), nullptr, visit);
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

}  // namespace

std::optional<std::string> WithTrueProgress(const GcodeFile& file, std::string_view text) {
  if (file.progress.empty()) return std::nullopt;
  const ProgressMoments was = MomentsOf(file, file.text);
  const ProgressMoments is = MomentsOf(file, text);
  if (was.lines.size() != is.lines.size()) return std::nullopt;
  std::vector<bool> goes(is.lines.size(), false);
  for (size_t i = 0; i < goes.size(); ++i) {
    const ProgressMoment& line = is.lines[i];
    goes[i] = line.in_print && std::abs(line.share - was.lines[i].share) > kMostOff &&
              !SaysLayer(text.substr(line.begin, line.end - line.begin));
  }
  if (std::find(goes.begin(), goes.end(), true) == goes.end()) return std::nullopt;
  std::string out;
  out.reserve(text.size());
  size_t copied = 0;  // of `text`
  size_t next = 0;    // of the lines of progress
  const auto write = [&](size_t end) {
    out.append(text.substr(copied, end - copied));
    copied = end;
  };
  const auto put_next = [&] {
    const ProgressMoment& line = is.lines[next++];
    out.append(text.substr(line.begin, line.end - line.begin));
  };
  size_t seen = 0;  // lines of progress that have been passed
  // The deposit before, in front of which a line may stand as well.
  size_t last = 0;
  double last_seconds = 0;
  const auto visit = [&](const Step& step, double seconds) {
    if (step.kind == StepKind::kProgress) {
      const size_t here = seen++;
      write(step.line.begin);
      // Those that are to stand before one that stays do so at the latest there.
      while (!goes[here] && next < here) put_next();
      if (goes[here]) {
        copied = step.line.next;
      } else {
        ++next;
      }
    } else if (step.kind == StepKind::kExtrude || seconds >= is.seconds) {
      while (next < goes.size() && goes[next]) {
        const double wanted = was.lines[next].share * is.seconds;
        if (wanted > seconds) break;
        const bool before = last > 0 && last >= copied && wanted - last_seconds < seconds - wanted;
        write(before ? last : step.line.begin);
        put_next();
      }
      last = step.line.begin;
      last_seconds = seconds;
    }
  };
  MeasureMoments(file, text, StartOfFile(file), nullptr, visit);
  write(text.size());
  while (next < goes.size()) put_next();
  return out;
}

}  // namespace traverse::gcode
