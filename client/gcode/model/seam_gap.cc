#include "client/gcode/model/seam_gap.h"

#include <cassert>
#include <cmath>
#include <optional>

#include "client/gcode/model/positions.h"

namespace traverse::gcode {
namespace {

// Smaller ones come from rounding.
constexpr double kLeastGapMm = 0.02;

// Both segments print as wide a line, but for the rounding of their filament.
constexpr double kSameRateShare = 0.01;

// What is left of the segment that ends earlier, in gaps.
constexpr double kLeastLeft = 1;

// A segment that goes on to the start of its loop is straight within rounding.
constexpr double kStraightMm = 0.0015;

// Filament per mm; 0 for arcs, and for what has no length.
double RateOf(const BodySegment& segment) {
  const double length = LengthXy(segment.from, segment.to);
  return segment.command < 2 && length > 0 ? ToDouble(segment.filament) / length : 0;
}

// How far `point` lies beside the line from `from` to `to`.
double BesideMm(const Position& point, const Position& from, const Position& to) {
  const double dx = ToDouble(to.x - from.x);
  const double dy = ToDouble(to.y - from.y);
  const double across = dx * ToDouble(point.y - from.y) - dy * ToDouble(point.x - from.x);
  return std::abs(across) / std::hypot(dx, dy);
}

// What closes the gap if the loop begins at `entry`; nothing if it stays where it is.
std::optional<BodySegment> ClosingOf(uint32_t entry, const std::vector<BodySegment>& segments) {
  assert(entry > 0 && entry < segments.size());
  const BodySegment& end = segments[entry - 1];
  BodySegment closing = segments.back();
  closing.from = segments.back().to;
  closing.to = segments.front().from;
  const double gap = LengthXy(closing.from, closing.to);
  const double length = LengthXy(end.from, end.to);
  if (gap < kLeastGapMm || length < (1 + kLeastLeft) * gap) return std::nullopt;
  const double rate = RateOf(segments.back());
  const double rate_at_end = RateOf(end);
  if (!(rate > 0) || !(std::abs(rate - rate_at_end) <= kSameRateShare * rate)) return std::nullopt;
  const double steps = (rate + rate_at_end) / 2 * gap * static_cast<double>(kDecimalOne) /
                       static_cast<double>(kFilamentStep);
  closing.filament = std::llround(steps) * kFilamentStep;
  if (closing.filament <= 0) return std::nullopt;
  return closing;
}

}  // namespace

bool MoveGap(uint32_t entry, std::vector<BodySegment>& segments) {
  const std::optional<BodySegment> found = ClosingOf(entry, segments);
  if (!found) return false;
  const BodySegment& closing = *found;
  BodySegment& end = segments[entry - 1];
  const double gap = LengthXy(closing.from, closing.to);
  const double length = LengthXy(end.from, end.to);
  end.filament -= closing.filament;
  end.to = Along(end.from, end.to, length - gap, 1);
  BodySegment& last = segments.back();
  // Of two segments both would be other ones: nothing would tell which loop it is.
  const bool only_two = segments.size() == 2;
  const bool onward = LengthXy(last.from, closing.to) > LengthXy(last.from, last.to);
  if (only_two || !onward || BesideMm(last.to, last.from, closing.to) > kStraightMm) {
    segments.push_back(closing);
  } else {
    last.to = closing.to;
    last.filament += closing.filament;
  }
  return true;
}

bool MovesGap(uint32_t entry, const std::vector<BodySegment>& segments) {
  return ClosingOf(entry, segments).has_value();
}

}  // namespace traverse::gcode
