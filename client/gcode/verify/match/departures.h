// What the moves of a link tell by themselves: where it leads from and to, and how travel leaves
// the path before it: some slicers move a little before they retract, so that nothing of that shows
// on a wall.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_DEPARTURES_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_DEPARTURES_H_

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "absl/types/span.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/text.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

// Whether two moves are of one kind and speed, end at one height and move as much filament.
inline bool AreAlike(const TraceMove& a, const TraceMove& b) {
  return a.kind == b.kind && std::abs(a.z_to_mm - b.z_to_mm) <= kHeightSlackMm &&
         a.feed == b.feed && a.spiral == b.spiral &&
         std::abs(a.filament - b.filament) <= VerifyMachine::kSlack;
}

inline bool Retracts(const TraceMove& move) {
  return move.kind == MoveKind::kRetraction || (move.kind == MoveKind::kWipe && move.filament < 0);
}

// The short move with which travel leaves the path before `link`; nothing if there is none. The
// head may rise to the next layer before it retracts, and wait.
inline const TraceMove* DepartureOf(const TraceChunk& chunk, uint32_t link) {
  constexpr double kLongestMm = 1.0;
  const absl::Span<const TraceMove> moves = chunk.MovesOf(link);
  if (moves.size() < 2 || chunk.links[link].scripted) return nullptr;
  const TraceMove& first = moves.front();
  const bool leaves = first.kind == MoveKind::kTravel && first.open && first.in_print &&
                      first.z_from_mm == first.z_to_mm && first.length_mm() >= kLeastDepartureMm &&
                      first.length_mm() <= kLongestMm;
  const auto next = std::find_if(moves.begin() + 1, moves.end() - 1, [](const TraceMove& move) {
    return move.kind != MoveKind::kUp && move.kind != MoveKind::kDwell;
  });
  return leaves && Retracts(*next) ? &first : nullptr;
}

// How many of the first of `moves` are no longer than `most_mm` together.
inline uint32_t MovesWithin(absl::Span<const TraceMove> moves, double most_mm) {
  double length = 0;
  const auto behind = std::ranges::find_if(
      moves, [&](const TraceMove& move) { return (length += move.length_mm()) > most_mm; });
  return static_cast<uint32_t>(behind - moves.begin());
}

// A digest of two points, to the micrometre.
inline uint64_t DigestOfEnds(Point from, Point to) {
  const auto um = [](double mm) { return static_cast<uint64_t>(std::llround(mm * 1000)); };
  return Mix(Mix(um(from.x), um(from.y)), Mix(um(to.x), um(to.y)));
}

// A digest of the end of the path before and the start of the path after, to the micrometre.
// REQUIRES: link > 0.
inline uint64_t EndsOf(const TraceChunk& chunk, uint32_t link) {
  assert(link > 0);
  return DigestOfEnds(chunk.EndOf(chunk.paths[link - 1]), chunk.paths[link].start);
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_DEPARTURES_H_
