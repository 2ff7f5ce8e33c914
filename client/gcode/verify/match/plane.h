// Distances and crossings in the plane.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PLANE_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PLANE_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

// The point that lies `share` of the way from `a` to `b`.
inline Point Between(Point a, Point b, double share) {
  return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

// The point of the straight line between `a` and `b` that is nearest to `p`.
Point NearestTo(Point p, Point a, Point b);

// From `p` to the straight line between `a` and `b`.
inline double DistanceToPiece(Point p, Point a, Point b) { return Distance(p, NearestTo(p, a, b)); }

// Between two straight lines; 0 if they cross.
double DistanceOfPieces(Point a, Point b, Point c, Point d);

// True if the line from `c` to `d` crosses the other one at a point inside that. Where a line
// passes a point at which two others meet from either side of it, it crosses one of these.
bool PiecesCross(Point a, Point b, Point c, Point d);

// A straight piece of a path.
struct Piece {
  Point a;
  Point b;
  uint32_t path = 0;
};

double LengthOf(absl::Span<const Piece> pieces);

// Appends the pieces of `path`: arcs become chords that lie within about 0.01 mm of them.
void AppendPieces(const TraceChunk& chunk, uint32_t path, std::vector<Piece>& pieces);

// A piece of more than one path.
inline constexpr uint32_t kSeveralPaths = UINT32_MAX;

// Leaves one of those that lie in the same place: loops may be printed there again and again.
void JoinEqual(std::vector<Piece>& pieces);

// Leaves out what comes to a place that has more pieces than can be printed there already.
void LeaveOutCrowds(std::vector<Piece>& pieces);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PLANE_H_
