// The sequence of lines that tell the progress is unchanged, and each stands about where what it
// states is true.

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// So many hundredths of the print farther off than in the original is little.
constexpr double kSlackPercent = 2;

// All is done where the last path ends, or behind the end script: slicers say it either way.
double PercentAt(double print_seconds, double seconds) {
  return print_seconds > 0 ? std::min(100 * seconds / print_seconds, 100.0) : 0;
}

// When a section begins and ends.
struct Span {
  double begin = 0;
  double end = 0;
};

Span SectionOf(const ProgressLog& log, uint32_t of) {
  const auto behind = std::ranges::upper_bound(log.begins, of, {}, &SectionBegin::section);
  Span span{0, log.seconds};
  if (behind != log.begins.begin()) span.begin = std::prev(behind)->seconds;
  if (behind != log.begins.end()) span.end = behind->seconds;
  return span;
}

// As far into `to` as `seconds` are into `from`.
double Transferred(double seconds, const Span& from, const Span& to) {
  const double length = from.end - from.begin;
  const double share = length > 0 ? (seconds - from.begin) / length : 0;
  return to.begin + share * (to.end - to.begin);
}

// By how much a line is farther off than it may be, and where it stands.
struct Displacement {
  double excess = 0;  // in hundredths of the print; above 0: too far
  double stated = 0;
  double percent = 0;
  double given = 0;
};

// How far the nearest one of `places`, ascending, is from `wanted`, if that lies between them;
// else 0: there may be a nearer one.
double ToPlace(double wanted, const std::array<double, 4>& places) {
  const auto behind = std::ranges::lower_bound(places, wanted);
  if (behind == places.begin() || behind == places.end()) return 0;
  return std::min(wanted - *std::prev(behind), *behind - wanted);
}

// A line is no farther off than it was, or stands between there and where it would be if it kept
// its place in its section, which is elsewhere where one section saves more time than another.
// Lines that state no share stay where they were. None is too far off if no place where it may
// stand is nearer. The prints take `was_seconds` and `is_seconds`.
Displacement DisplacementOf(const ProgressLog& was, double was_seconds, const ProgressLog& is,
                            double is_seconds, size_t i) {
  Displacement found;
  found.given = PercentAt(was_seconds, was.lines[i].seconds);
  found.percent = PercentAt(is_seconds, is.lines[i].seconds);
  found.stated = was.lines[i].percent >= 0 ? was.lines[i].percent : found.given;
  const uint32_t section = was.lines[i].section;
  const double alike =
      PercentAt(is_seconds,
                Transferred(was.lines[i].seconds, SectionOf(was, section), SectionOf(is, section)));
  const double off = std::abs(found.given - found.stated);
  const double least = std::min(found.stated - off, alike);
  const double most = std::max(found.stated + off, alike);
  std::array<double, 4> places = is.lines[i].places;
  for (double& place : places) place = PercentAt(is_seconds, place);
  const double early = least - found.percent - ToPlace(least, places);
  const double late = found.percent - most - ToPlace(most, places);
  found.excess = std::max(early, late) - kSlackPercent;
  return found;
}

void ComparePlace(const ProgressLog& was, const ProgressLog& is, size_t i,
                  std::vector<Finding>& breaks) {
  const Displacement of_print = DisplacementOf(was, was.seconds, is, is.seconds, i);
  if (of_print.excess <= 0) return;
  const Displacement of_file = DisplacementOf(was, was.all_seconds, is, is.all_seconds, i);
  if (of_file.excess <= 0) return;
  breaks.push_back({VerifyRule::kProgress, was.lines[i].line, is.lines[i].line,
                    absl::StrFormat("states %.0f %% at %.1f %% of the print time; in the original "
                                    "it stands at %.1f %%",
                                    of_file.stated, of_file.percent, of_file.given)});
}

}  // namespace

void ProgressLog::Append(const TraceChunk& chunk) {
  lines.insert(lines.end(), chunk.progress.begin(), chunk.progress.end());
  begins.insert(begins.end(), chunk.begins.begin(), chunk.begins.end());
  if (!chunk.paths.empty()) seconds = chunk.paths.back().left_seconds;
  all_seconds = chunk.seconds;
}

void CompareProgress(const ProgressLog& was, const ProgressLog& is, std::vector<Finding>& breaks) {
  const auto [one, other] =
      std::ranges::mismatch(was.lines, is.lines, {}, &Progress::digest, &Progress::digest);
  if (one != was.lines.end() || other != is.lines.end()) {
    breaks.push_back({VerifyRule::kProgress, one == was.lines.end() ? 0 : one->line,
                      other == is.lines.end() ? 0 : other->line,
                      "this line of progress is out of sequence"});
    return;
  }
  for (size_t i = 0; i < was.lines.size(); ++i) ComparePlace(was, is, i, breaks);
}

}  // namespace traverse::gcode
