#include "client/gcode/verify/match/turned_departures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/gcode/verify/match/slacks.h"

namespace traverse::gcode {
namespace {

// One of a path's starts, and which way its segments lead away from there: the first one and,
// backwards, the last one.
struct StartOfLoop {
  Point at;
  double first = 0;  // in radians
  double last = 0;
  double first_mm = 0;
};

double DirectionOf(Point from, Point to) { return std::atan2(to.y - from.y, to.x - from.x); }

// From direction `a` to `b`, to the left or to the right: 0 to 2 pi.
double TurnOf(double a, double b, bool left) {
  constexpr double kRound = 2 * std::numbers::pi;
  const double turn = std::fmod(left ? b - a : a - b, kRound);
  return turn < 0 ? turn + kRound : turn;
}

StartOfLoop StartAt(const TraceChunk& chunk, const TracePath& path, uint32_t entry) {
  const uint32_t segment = path.first_segment + entry;
  const uint32_t before = (entry == 0 ? path.end_segment : segment) - 1;
  const Point at = chunk.StartOf(path, segment);
  const bool closes = segment + 1 == path.end_segment;
  const Point next = closes ? path.start : chunk.segments[segment].end;
  return {at, DirectionOf(at, next), DirectionOf(at, chunk.StartOf(path, before)),
          Distance(at, next)};
}

// The open move with which travel from the path begins, if it is so short; else nothing.
const TraceMove* ShortMoveFrom(const TraceChunk& chunk, uint32_t link) {
  if (chunk.MovesOf(link).empty()) return nullptr;
  const TraceMove& first = chunk.MovesOf(link).front();
  const bool departs = first.kind == MoveKind::kTravel && first.open && first.in_print &&
                       first.length_mm() <= kLongestDepartureMm;
  return departs ? &first : nullptr;
}

// Where the move leads that leads to `departed` in the original, if the loop begins as `visit`.
Point TurnedEnd(const TraceChunk& was, const Visit& visit, Point departed) {
  const TracePath& path = was.paths[visit.path];
  const StartOfLoop had = StartAt(was, path, 0);
  const StartOfLoop has = StartAt(was, path, visit.entry);
  const double direction = DirectionOf(had.at, departed);
  const bool left = TurnOf(had.first, direction, true) < std::numbers::pi;
  const double share = TurnOf(had.first, direction, left) / TurnOf(had.first, had.last, left);
  const double turned = share * TurnOf(has.first, has.last, left);
  const double leads = has.first + (left ? turned : -turned);
  const double mm = std::min(Distance(had.at, departed), has.first_mm);
  return {has.at.x + mm * std::cos(leads), has.at.y + mm * std::sin(leads)};
}

}  // namespace

absl::flat_hash_set<uint32_t> TurnedDepartures(const LayerPair& layer) {
  const TraceChunk& was = layer.was();
  absl::flat_hash_set<uint32_t> links;
  for (const Visit& visit : layer.visits()) {
    const bool moved = visit.forward && visit.entry > 0 && layer.Closed(visit.path);
    if (!moved || visit.segments != was.paths[visit.path].size()) continue;
    const TraceMove* had = ShortMoveFrom(was, visit.path + 1);
    if (had == nullptr || !layer.EndsPath(visit)) continue;
    const uint32_t link = visit.last_path + 1;
    const TraceMove* has = ShortMoveFrom(layer.is(), link);
    const bool turned =
        has != nullptr && Distance(has->to, TurnedEnd(was, visit, had->to)) < kSamePointMm;
    if (turned) links.insert(link);
  }
  return links;
}

}  // namespace traverse::gcode
