// The short move with which travel leaves a path before it retracts, so that nothing of that shows
// on a wall.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_DEPARTURES_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_DEPARTURES_H_

#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

inline bool Retracts(const TraceMove& move) {
  return move.kind == MoveKind::kRetraction || (move.kind == MoveKind::kWipe && move.filament < 0);
}

// That of `link`; nothing if there is none. The head may rise to the next layer before it retracts,
// and wait.
inline const TraceMove* DepartureOf(const TraceChunk& chunk, uint32_t link) {
  constexpr double kLongestMm = 1.0;
  const TraceLink& traced = chunk.links[link];
  if (traced.end_move - traced.first_move < 2 || traced.scripted) return nullptr;
  const TraceMove& first = chunk.moves[traced.first_move];
  const bool leaves = first.kind == MoveKind::kTravel && first.open && first.in_print &&
                      first.z_from_mm == first.z_to_mm && first.length_mm() >= kLeastDepartureMm &&
                      first.length_mm() <= kLongestMm;
  uint32_t next = traced.first_move + 1;
  const auto goes_on = [&chunk](uint32_t m) {
    return chunk.moves[m].kind == MoveKind::kUp || chunk.moves[m].kind == MoveKind::kDwell;
  };
  while (next + 1 < traced.end_move && goes_on(next)) ++next;
  return leaves && Retracts(chunk.moves[next]) ? &first : nullptr;
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_DEPARTURES_H_
