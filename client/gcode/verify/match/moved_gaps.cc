#include "client/gcode/verify/match/moved_gaps.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <list>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "absl/strings/str_format.h"
#include "client/gcode/parallel.h"
#include "client/gcode/verify/match/plane.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/match/visits.h"

namespace traverse::gcode {
namespace {

// Coordinates in thousandths, and filament in hundred-thousandths, are rounded by less.
constexpr double kRoundedMm = 0.002;
constexpr double kRoundedFilamentMm = 2e-5;
constexpr double kRoundedFilamentShare = 0.02;

// Both sides are sums of integers of 1e-6.
constexpr double kSameFilamentMm = 1.5e-6;

// They differ in number, or in what they are.
bool DepositsDiffer(absl::Span<const TraceSegment> a, absl::Span<const TraceSegment> b) {
  const auto sum = [](absl::Span<const TraceSegment> deposits) {
    return std::accumulate(deposits.begin(), deposits.end(), uint64_t{0},
                           [](uint64_t all, const TraceSegment& one) { return all + one.digest; });
  };
  return a.size() != b.size() || sum(a) != sum(b);
}

// A loop of the original, and the path of the other file that prints it with its gap moved.
struct MovedLoop {
  uint32_t path = 0;
  uint32_t entry = 0;  // the segment with which the other begins
  uint32_t other = 0;
  uint32_t first = 0;  // segment of the other, where it begins: another path may end there

  // The segment of the other that closes the gap; if not `apart`, it is the loop's last segment
  // too.
  uint32_t closing = 0;
  bool apart = true;
};

// The loop at `path`, if the other side begins it with segment `entry`.
struct LoopStart {
  uint32_t path = 0;
  uint32_t entry = 0;
};

// Starts of loops by a digest that is printed there, in the order of the original.
class LoopStarts {
 public:
  void Add(uint64_t digest, const LoopStart& start) { starts_[digest].push_back(start); }

  // Shows `is_it` the starts with `digest` whose loop `is_found` does not know yet; true once it
  // takes one. Forgets the others that it passes.
  template <typename IsFound, typename IsIt>
  bool Find(uint64_t digest, IsFound is_found, IsIt is_it) {
    std::list<LoopStart>& starts = starts_[digest];
    uint32_t left = kMostEqual;
    for (auto start = starts.begin(); start != starts.end() && left > 0;) {
      if (is_found(start->path)) {
        start = starts.erase(start);
        continue;
      }
      if (is_it(*start++)) return true;
      --left;
    }
    return false;
  }

 private:
  absl::flat_hash_map<uint64_t, std::list<LoopStart>> starts_;
};

class SectionGaps {
 public:
  SectionGaps(const TraceChunk& original, const TraceSection& was, const TraceChunk& optimised,
              const TraceSection& is)
      : original_(original),
        optimised_(optimised),
        first_path_(was.first_path),
        found_(was.end_path - was.first_path, false) {
    for (uint32_t p = was.first_path; p < was.end_path; ++p) {
      const TracePath& path = original.paths[p];
      const bool gap = Distance(path.start, original.EndOf(path)) > kSameSpotMm;
      if (!gap || !IsClosed(original, p)) continue;
      for (uint32_t s = path.first_segment + 1; s < path.end_segment; ++s) {
        starts_.Add(original.segments[s].digest, {p, s - path.first_segment});
      }
      // If the other begins with the last segment and that goes on, the next one is the first that
      // is the same.
      if (path.size() < 3) continue;
      onward_starts_.Add(original.segments[path.first_segment].digest, {p, path.size() - 1});
    }
    for (const TraceSegment& segment : optimised.SegmentsOf(is)) ++surplus_[segment.digest];
    for (const TraceSegment& segment : original.SegmentsOf(was)) --surplus_[segment.digest];
  }

  // The loop that path `other` prints, or ends with, if it is one that takes its gap along. Each is
  // found once. The other has `least` more of the segment that closes the gap than the original,
  // and as many less of those that it prints changed: where loops have changed their starts with
  // each other, one may close its gap with the segment that another one has lost.
  std::optional<MovedLoop> Find(uint32_t other, int64_t least) {
    const TracePath& path = optimised_.paths[other];
    if (path.joined || SurplusOf(path.end_segment - 1) < 1) return std::nullopt;
    std::optional<MovedLoop> loop;
    for (uint32_t first = path.first_segment; first < path.end_segment && !loop; ++first) {
      loop = FindFrom(first, other, least);
    }
    if (!loop) return std::nullopt;
    found_[loop->path - first_path_] = true;
    --surplus_[optimised_.segments[loop->closing].digest];
    --surplus_[optimised_.segments[path.end_segment - 1].digest];
    for (const uint64_t lacking : SegmentsOf(*loop)) ++surplus_[lacking];
    return loop;
  }

 private:
  std::optional<MovedLoop> FindFrom(uint32_t first, uint32_t other, int64_t least) {
    std::optional<MovedLoop> loop;
    const auto is_found = [this](uint32_t p) -> bool { return found_[p - first_path_]; };
    const auto is_it = [&](const LoopStart& start) {
      loop = LoopAt(start, first, other);
      const bool may_be = loop && SurplusOf(loop->closing) >= least && Lacks(*loop, least);
      if (!may_be || !IsMoved(*loop)) loop.reset();
      return loop.has_value();
    };
    const uint32_t size = optimised_.paths[other].end_segment - first;
    const auto digest = [&](uint32_t s) { return optimised_.segments[first + s].digest; };
    const bool found = starts_.Find(digest(0), is_found, is_it) ||
                       (size >= 3 && onward_starts_.Find(digest(1), is_found, is_it));
    return found ? loop : std::nullopt;
  }

  // How many more of this segment the other has: where the original prints loops one upon the other
  // that begin at different points, one looks like another one that was moved.
  int64_t SurplusOf(uint32_t segment) const {
    return surplus_.at(optimised_.segments[segment].digest);
  }

  // Those of the original that the other prints changed.
  std::vector<uint64_t> SegmentsOf(const MovedLoop& loop) const {
    const TracePath& was = original_.paths[loop.path];
    std::vector<uint64_t> digests{original_.segments[was.first_segment + loop.entry - 1].digest};
    if (!loop.apart) digests.push_back(original_.segments[was.end_segment - 1].digest);
    return digests;
  }

  bool Lacks(const MovedLoop& loop, int64_t least) const {
    const std::vector<uint64_t> digests = SegmentsOf(loop);
    return std::ranges::all_of(digests,
                               [&](uint64_t digest) { return surplus_.at(digest) <= -least; });
  }

  // Nothing if `other` has too many or too few segments from `first` on to be the loop.
  std::optional<MovedLoop> LoopAt(const LoopStart& start, uint32_t first, uint32_t other) const {
    const uint32_t size = optimised_.paths[other].end_segment - first;
    const uint32_t n = original_.paths[start.path].size();
    const bool apart = size > n;
    if (size != (apart ? n + 1 : n)) return std::nullopt;
    const uint32_t before_gap = n - start.entry;
    return MovedLoop{
        start.path, start.entry, other, first, first + (apart ? before_gap : before_gap - 1),
        apart};
  }

  bool IsMoved(const MovedLoop& loop) const {
    const TracePath& was = original_.paths[loop.path];
    const TracePath& is = optimised_.paths[loop.other];
    const uint32_t closing = loop.closing - loop.first;
    const auto same_place = [](Point a, Point b) { return Distance(a, b) <= kSameSpotMm; };
    if (!same_place(optimised_.StartOf(is, loop.first),
                    original_.StartOf(was, was.first_segment + loop.entry))) {
      return false;
    }
    for (uint32_t i = 0; loop.first + i + 1 < is.end_segment; ++i) {
      if (i == closing) continue;
      const uint32_t s = was.first_segment + (i < closing ? loop.entry + i : i - closing - 1);
      if (original_.segments[s].digest != optimised_.segments[loop.first + i].digest) return false;
    }
    const uint32_t shorter = was.first_segment + loop.entry - 1;
    const Point begin =
        loop.apart ? original_.EndOf(was) : original_.StartOf(was, was.end_segment - 1);
    return same_place(optimised_.StartOf(is, loop.closing), begin) &&
           same_place(optimised_.segments[loop.closing].end, was.start) &&
           same_place(optimised_.StartOf(is, is.end_segment - 1),
                      original_.StartOf(was, shorter)) &&
           Alike(was.end_segment - 1, loop.closing) && Alike(shorter, is.end_segment - 1);
  }

  // Both are straight, and printed alike.
  bool Alike(uint32_t was, uint32_t is) const {
    return original_.segments[was].arc < 0 && optimised_.segments[is].arc < 0 &&
           original_.segments[was].conditions == optimised_.segments[is].conditions;
  }

  const TraceChunk& original_;
  const TraceChunk& optimised_;
  const uint32_t first_path_;
  LoopStarts starts_;         // by the first segment
  LoopStarts onward_starts_;  // by the second one, where the first closes the gap
  std::vector<bool> found_;   // [path of the original - first_path_]
  // By digest: how many more segments the other has than the original, but for loops found.
  absl::flat_hash_map<uint64_t, int64_t> surplus_;
};

// What is wrong with the filament or the length of `loop`; empty if nothing is.
std::string FaultOf(const TraceChunk& original, const TraceChunk& optimised,
                    const MovedLoop& loop) {
  const TracePath& was = original.paths[loop.path];
  const TracePath& is = optimised.paths[loop.other];
  const auto rate = [&](uint32_t segment) {
    return original.segments[segment].filament_mm /
           Distance(original.StartOf(was, segment), original.segments[segment].end);
  };
  const uint32_t shorter = was.first_segment + loop.entry - 1;
  const TraceSegment& whole = original.segments[shorter];
  const TraceSegment& cut = optimised.segments[is.end_segment - 1];
  const double gap = Distance(original.EndOf(was), was.start);
  const double left = Distance(cut.end, whole.end);
  const double off = DistanceToPiece(cut.end, original.StartOf(was, shorter), whole.end);
  if (off > kRoundedMm || std::abs(left - gap) > kRoundedMm) {
    return absl::StrFormat(
        "this loop ends %.3f mm from its start, %.3f mm beside its last segment; in the original "
        "it ends %.3f mm short of its start",
        left, off, gap);
  }
  if (!loop.apart) {
    const double bend =
        DistanceToPiece(original.EndOf(was), original.StartOf(was, was.end_segment - 1), was.start);
    if (bend > kRoundedMm) {
      return absl::StrFormat("what closes the gap of this loop leaves out a bend of %.3f mm", bend);
    }
  }
  const double before = loop.apart ? 0 : original.segments[was.end_segment - 1].filament_mm;
  const double closing = optimised.segments[loop.closing].filament_mm - before;
  const double saved = whole.filament_mm - cut.filament_mm;
  if (std::abs(closing - saved) > kSameFilamentMm) {
    return absl::StrFormat(
        "%.5f mm of filament close the gap of this loop, and its end has %.5f mm less", closing,
        saved);
  }
  for (const double due : {rate(was.end_segment - 1) * gap, rate(shorter) * gap}) {
    if (std::abs(closing - due) <= kRoundedFilamentMm + kRoundedFilamentShare * due) continue;
    return absl::StrFormat(
        "%.5f mm of filament close the gap of this loop, where its other segments would have %.5f "
        "mm on that length",
        closing, due);
  }
  return "";
}

// Removes the segments `removed`, ascending; each is within a path, and the segment before it ends
// where it did.
void Remove(const std::vector<uint32_t>& removed, TraceChunk& chunk) {
  for (const uint32_t segment : removed) {
    chunk.segments[segment - 1].end = chunk.segments[segment].end;
  }
  const auto now = [&removed](uint32_t segment) {
    const auto before = std::ranges::lower_bound(removed, segment);
    return segment - static_cast<uint32_t>(before - removed.begin());
  };
  for (TracePath& path : chunk.paths) {
    path.first_segment = now(path.first_segment);
    path.end_segment = now(path.end_segment);
  }
  for (TraceCommand& command : chunk.commands) command.segment = now(command.segment);
  size_t kept = 0;
  auto next = removed.begin();
  for (uint32_t s = 0; s < chunk.segments.size(); ++s) {
    if (next != removed.end() && *next == s) {
      ++next;
    } else {
      chunk.segments[kept++] = chunk.segments[s];
    }
  }
  chunk.segments.resize(kept);
}

// What is found in one section.
struct FoundGaps {
  std::vector<MovedGap> gaps;
  std::vector<uint32_t> removed;  // segments, ascending
  std::vector<Finding> findings;
};

void TakeBack(const TraceChunk& original, TraceChunk& optimised, size_t section, FoundGaps& found,
              const WorkLimit& limit) {
  const TraceSection& was = original.sections[section];
  const TraceSection& is = optimised.sections[section];
  const absl::Span<const TraceSegment> deposits_was = original.SegmentsOf(was);
  const absl::Span<const TraceSegment> deposits_is = optimised.SegmentsOf(is);
  if (was.index != is.index || deposits_is.size() < deposits_was.size()) return;
  if (!DepositsDiffer(deposits_was, deposits_is)) return;
  SectionGaps of_section(original, was, optimised, is);
  // Once more for loops of one place that have changed their starts with each other.
  const uint32_t paths = is.end_path - is.first_path;
  for (uint32_t i = 0; i < 2 * paths && !limit.Ended(); ++i) {
    const uint32_t p = is.first_path + i % paths;
    const std::optional<MovedLoop> loop = of_section.Find(p, i < paths ? 1 : 0);
    if (!loop) continue;
    const TracePath& path = original.paths[loop->path];
    TraceSegment& last = optimised.segments[optimised.paths[p].end_segment - 1];
    if (std::string fault = FaultOf(original, optimised, *loop); !fault.empty()) {
      found.findings.push_back(
          {VerifyRule::kSamePrint, original.LineOf(path), last.line, std::move(fault)});
    }
    TraceSegment& closing = optimised.segments[loop->closing];
    MovedGap& gap = found.gaps.emplace_back(MovedGap{is.index, {closing.digest, last.digest}, {}});
    last.digest = original.segments[path.first_segment + loop->entry - 1].digest;
    gap.as.push_back(last.digest);
    if (loop->apart) {
      found.removed.push_back(loop->closing);
    } else {
      closing.digest = original.segments[path.end_segment - 1].digest;
      gap.as.push_back(closing.digest);
    }
  }
  std::ranges::sort(found.removed);
}

}  // namespace

std::vector<MovedGap> TakeBackMovedGaps(const TraceChunk& original, TraceChunk& optimised,
                                        int threads, std::vector<Finding>& findings,
                                        const WorkLimit& limit) {
  std::vector<FoundGaps> found(std::min(original.sections.size(), optimised.sections.size()));
  // Each section changes only segments of its own.
  ParallelFor(
      found.size(), threads, [&](size_t i) { TakeBack(original, optimised, i, found[i], limit); },
      limit);
  std::vector<MovedGap> gaps;
  std::vector<uint32_t> removed;
  for (FoundGaps& each : found) {
    std::move(each.gaps.begin(), each.gaps.end(), std::back_inserter(gaps));
    std::move(each.findings.begin(), each.findings.end(), std::back_inserter(findings));
    removed.insert(removed.end(), each.removed.begin(), each.removed.end());
  }
  if (!removed.empty()) Remove(removed, optimised);
  return gaps;
}

}  // namespace traverse::gcode
