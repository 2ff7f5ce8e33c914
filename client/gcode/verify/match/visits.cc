#include "client/gcode/verify/match/visits.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/verify/match/slacks.h"

namespace traverse::gcode {
namespace {

constexpr uint32_t kNone = UINT32_MAX;

// The gap of a loop, at most, where lines are not wide.
constexpr double kUsualGapMm = 0.131;

// The segments of a section that are not used yet, by their digests; the same digest may be there
// any number of times.
class SegmentTable {
 public:
  SegmentTable(const TraceChunk& chunk, uint32_t first, uint32_t end)
      : first_(first), next_(end - first, kNone), used_(end - first, false) {
    heads_.reserve(end - first);
    for (uint32_t s = end; s > first; --s) {
      uint32_t& head = heads_.try_emplace(chunk.segments[s - 1].digest, kNone).first->second;
      next_[s - 1 - first] = std::exchange(head, s - 1);
    }
  }

  bool Unused(uint32_t s) const { return !used_[s - first_]; }
  void Use(uint32_t s) { used_[s - first_] = true; }

  // In their order, until visit returns false. Takes those that are used out of the way, so that
  // each is passed once.
  template <typename Visit>
  void ForEachUnused(uint64_t digest, Visit visit) {
    const auto head = heads_.find(digest);
    uint32_t* at = head == heads_.end() ? nullptr : &head->second;
    while (at != nullptr && *at != kNone) {
      uint32_t& next = next_[*at - first_];
      if (Unused(*at)) {
        if (!visit(*at)) return;
        at = &next;
      } else {
        *at = next;
      }
    }
  }

 private:
  const uint32_t first_;
  absl::flat_hash_map<uint64_t, uint32_t> heads_;  // the first that may be unused, by digest
  std::vector<uint32_t> next_;                     // [segment - first_], with the same digest
  std::vector<bool> used_;                         // the same
};

class Matcher {
 public:
  Matcher(const TraceChunk& original, const TraceSection& was, const TraceChunk& optimised,
          const TraceSection& is, const WorkLimit& limit)
      : original_(original),
        optimised_(optimised),
        is_(is),
        limit_(limit),
        first_path_(was.first_path),
        first_(original.paths[was.first_path].first_segment),
        end_(original.paths[was.end_path - 1].end_segment),
        table_(original, first_, end_) {
    path_of_.reserve(end_ - first_);
    for (uint32_t p = was.first_path; p < was.end_path; ++p) {
      path_of_.insert(path_of_.end(), original.paths[p].size(), p);
      closed_.push_back(IsClosed(original, p));
    }
  }

  std::vector<Visit> Match() {
    for (uint32_t p = is_.first_path; p < is_.end_path && !limit_.Ended(); ++p) MatchPath(p);
    return std::move(visits_);
  }

 private:
  bool Closed(uint32_t path) const { return closed_[path - first_path_]; }
  bool Unused(uint32_t s) const { return table_.Unused(s); }

  // The segment after `s` in its path, or before it; kNone: none.
  uint32_t Next(uint32_t s, bool forward) const {
    const uint32_t p = path_of_[s - first_];
    const TracePath& path = original_.paths[p];
    if (forward) {
      if (s + 1 < path.end_segment) return s + 1;
      return Closed(p) ? path.first_segment : kNone;
    }
    if (s > path.first_segment) return s - 1;
    return Closed(p) ? path.end_segment - 1 : kNone;
  }

  bool IsForward(uint32_t s, Point start) const {
    const TracePath& path = original_.paths[path_of_[s - first_]];
    const double to_start = Distance(original_.StartOf(path, s), start);
    return to_start <= kSameSpotMm || to_start <= Distance(original_.segments[s].end, start);
  }

  // How many segments of the original follow one another from `s` on as those of path `p` do from
  // `at` on, over the gap of a loop as well.
  uint32_t RunFrom(uint32_t s, uint32_t p, uint32_t at) const {
    const bool forward = IsForward(s, optimised_.StartOf(optimised_.paths[p], at));
    const uint32_t most = original_.paths[path_of_[s - first_]].size();
    uint32_t run = 1;
    for (; run < most; ++run) {
      s = Next(s, forward);
      if (s == kNone || !Unused(s)) break;
      if (at + run == optimised_.paths[p].end_segment) {
        if (p + 1 == is_.end_path || !OnlyGap(p, p + 1)) break;
        ++p;
      }
      if (original_.segments[s].digest != optimised_.segments[at + run].digest) break;
    }
    return run;
  }

  // The segment of the original for segment `at`: of several the one that continues the current
  // path, otherwise the one that agrees for longest.
  uint32_t Find(uint32_t p, uint32_t at) {
    const uint64_t digest = optimised_.segments[at].digest;
    if (due_ != kNone && Unused(due_) && original_.segments[due_].digest == digest) return due_;
    uint32_t found = kNone;
    uint32_t others = 0;
    table_.ForEachUnused(digest, [&](uint32_t s) {
      if (found == kNone || s == guess_) found = s;
      return ++others < kMostEqual;
    });
    if (others <= 1) return found;
    uint32_t longest = RunFrom(found, p, at);
    table_.ForEachUnused(digest, [&](uint32_t s) {
      if (s == found) return true;
      const uint32_t run = RunFrom(s, p, at);
      if (run > longest) {
        found = s;
        longest = run;
      }
      return --others > 0;
    });
    return found;
  }

  void MatchPath(uint32_t p) {
    const TracePath& path = optimised_.paths[p];
    for (uint32_t at = path.first_segment; at < path.end_segment;) {
      uint32_t s = Find(p, at);
      if (s == kNone) return;  // not the same deposits
      Visit visit;
      visit.path = path_of_[s - first_];
      visit.entry = s - original_.paths[visit.path].first_segment;
      visit.forward = IsForward(s, optimised_.StartOf(path, at));
      visit.first_path = visit.last_path = p;
      visit.first_segment = at;
      for (;;) {
        table_.Use(s);
        ++visit.segments;
        visit.last_segment = at++;
        guess_ = s + 1;
        const uint32_t next = Next(s, visit.forward);
        due_ = next;
        if (at >= path.end_segment || next == kNone || !Unused(next) ||
            original_.segments[next].digest != optimised_.segments[at].digest) {
          break;
        }
        s = next;
      }
      Add(visit);
    }
  }

  // Joins a visit with the one before it if they are the two parts of a loop, from its middle to
  // its end and from its start to its middle.
  void Add(const Visit& visit) {
    if (!visits_.empty()) {
      Visit& before = visits_.back();
      const uint32_t n = original_.paths[visit.path].size();
      const uint32_t joint = visit.forward ? 0 : n - 1;
      const uint32_t reached =
          before.forward ? before.entry + before.segments : before.entry + 1 - before.segments;
      const bool at_end = before.forward ? reached == n : reached == 0;
      if (before.path == visit.path && before.forward == visit.forward && Closed(visit.path) &&
          at_end && visit.entry == joint && before.segments + visit.segments <= n &&
          OnlyGap(before.last_path, visit.first_path)) {
        before.segments += visit.segments;
        before.last_path = visit.last_path;
        before.last_segment = visit.last_segment;
        return;
      }
    }
    visits_.push_back(visit);
  }

  // True if nothing is between the two but the gap of a loop.
  bool OnlyGap(uint32_t path, uint32_t next) const {
    if (path == next) return true;
    if (path + 1 != next) return false;
    double gap = 0;
    for (const TraceMove& move : optimised_.MovesOf(next)) {
      if (move.kind != MoveKind::kTravel || !move.open || move.z_from_mm != move.z_to_mm) {
        return false;
      }
      gap += move.length_mm();
    }
    return gap <= LoopGapMm(optimised_, path);
  }

  const TraceChunk& original_;
  const TraceChunk& optimised_;
  const TraceSection& is_;
  const WorkLimit& limit_;
  const uint32_t first_path_;
  const uint32_t first_;
  const uint32_t end_;
  SegmentTable table_;
  std::vector<uint32_t> path_of_;
  std::vector<bool> closed_;
  uint32_t guess_ = kNone;  // the segment that comes next in the original
  uint32_t due_ = kNone;    // the same of the path that is being printed
  std::vector<Visit> visits_;
};

}  // namespace

double LoopGapMm(const TraceChunk& chunk, uint32_t path) {
  constexpr double kShareOfWidth = 0.2;  // and what the estimate of the width may lack
  constexpr double kFilamentMm2 = 2.85 * 2.85 * M_PI / 4;
  const TracePath& traced = chunk.paths[path];
  if (!(traced.length_mm > 0)) return kUsualGapMm;
  // Lines are about twice as wide as high.
  const double area = static_cast<double>(traced.filament_mm / traced.length_mm) * kFilamentMm2;
  return std::max(kUsualGapMm, kShareOfWidth * std::sqrt(std::max(2 * area, 0.0)));
}

bool IsClosed(const TraceChunk& chunk, uint32_t path) {
  const TracePath& traced = chunk.paths[path];
  const double gap = Distance(traced.start, chunk.EndOf(traced));
  return traced.size() >= 2 && !traced.joined && gap <= LoopGapMm(chunk, path) &&
         static_cast<double>(traced.length_mm) > 4 * std::max(gap, kUsualGapMm);
}

std::vector<Visit> FindVisits(const TraceChunk& original, const TraceSection& was,
                              const TraceChunk& optimised, const TraceSection& is,
                              const WorkLimit& limit) {
  assert(original.SegmentsOf(was).size() == optimised.SegmentsOf(is).size());
  return Matcher(original, was, optimised, is, limit).Match();
}

}  // namespace traverse::gcode
