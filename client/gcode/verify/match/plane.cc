#include "client/gcode/verify/match/plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "absl/container/flat_hash_map.h"

namespace traverse::gcode {
namespace {

constexpr double kChordMm = 0.01;  // an arc may lie this far from its chord
constexpr double kMostChords = 360;
constexpr double kMostArcMm = 10'000;  // longer than any print's: of a few chords
constexpr double kMostChordsOfLong = 16;

double Side(Point a, Point b, Point p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

void AppendArc(Point from, Point to, const TraceArc& arc, uint32_t path,
               std::vector<Piece>& pieces) {
  const ArcWay way(from, to, arc);
  const double step = way.radius() > kChordMm ? 2 * std::acos(1 - kChordMm / way.radius()) : M_PI;
  // Of an arc as large as a line is long the step is 0.
  const double most = way.angle() * way.radius() > kMostArcMm ? kMostChordsOfLong : kMostChords;
  const int n = static_cast<int>(std::clamp(std::ceil(way.angle() / step), 1.0, most));
  Point at = from;
  for (int k = 1; k <= n; ++k) {
    const Point next = k == n ? to : way.At(k, n);
    pieces.push_back({at, next, path});
    at = next;
  }
}

}  // namespace

Point NearestTo(Point p, Point a, Point b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  if (squared <= 0) return a;
  return Between(a, b, std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0));
}

bool PiecesCross(Point a, Point b, Point c, Point d) {
  // What is so near to the line lies on it, and counts as on one side of it.
  constexpr double kOnLineMm = 1e-7;
  const double on_line = kOnLineMm * Distance(a, b);
  if ((Side(a, b, c) < -on_line) == (Side(a, b, d) < -on_line)) return false;
  const double a_side = Side(c, d, a);
  const double b_side = Side(c, d, b);
  return (a_side < 0 && b_side > 0) || (a_side > 0 && b_side < 0);
}

double DistanceOfPieces(Point a, Point b, Point c, Point d) {
  if (PiecesCross(a, b, c, d)) return 0;
  return std::min({DistanceToPiece(a, c, d), DistanceToPiece(b, c, d), DistanceToPiece(c, a, b),
                   DistanceToPiece(d, a, b)});
}

double LengthOf(absl::Span<const Piece> pieces) {
  double length = 0;
  for (const Piece& piece : pieces) length += Distance(piece.a, piece.b);
  return length;
}

void AppendPieces(const TraceChunk& chunk, uint32_t path, std::vector<Piece>& pieces) {
  const TracePath& traced = chunk.paths[path];
  Point at = traced.start;
  for (uint32_t s = traced.first_segment; s < traced.end_segment; ++s) {
    const TraceSegment& segment = chunk.segments[s];
    if (segment.arc >= 0) {
      AppendArc(at, segment.end, chunk.arcs[static_cast<size_t>(segment.arc)], path, pieces);
    } else {
      pieces.push_back({at, segment.end, path});
    }
    at = segment.end;
  }
}

void JoinEqual(std::vector<Piece>& pieces) {
  absl::flat_hash_map<std::array<double, 4>, size_t> places;
  places.reserve(pieces.size());
  size_t kept = 0;
  for (const Piece piece : pieces) {
    const auto [place, added] =
        places.try_emplace({piece.a.x, piece.a.y, piece.b.x, piece.b.y}, kept);
    if (added) {
      pieces[kept++] = piece;
    } else if (pieces[place->second].path != piece.path) {
      pieces[place->second].path = kSeveralPaths;
    }
  }
  pieces.resize(kept);
}

void LeaveOutCrowds(std::vector<Piece>& pieces) {
  // Of the shortest that slicers write, side by side, a square millimeter has a few hundred.
  constexpr uint32_t kMost = 1000;
  if (pieces.size() <= kMost) return;
  // They are looked for at each millimeter along the pieces, but at no more than so many places.
  const double most = 8.0 * static_cast<double>(pieces.size()) + (1 << 16);
  const double step_mm = std::max(1.0, LengthOf(pieces) / most);
  absl::flat_hash_map<std::pair<double, double>, uint32_t> pieces_at;  // by square millimeter
  std::erase_if(pieces, [&](const Piece& piece) {
    const double steps = std::ceil(Distance(piece.a, piece.b) / step_mm);
    bool crowded = false;
    std::pair<double, double> last(NAN, NAN);
    for (double step = 0; step <= steps; ++step) {
      const Point at = Between(piece.a, piece.b, steps > 0 ? step / steps : 0);
      const std::pair here(std::floor(at.x), std::floor(at.y));
      if (here != last) crowded |= ++pieces_at[here] > kMost;
      last = here;
    }
    return crowded;
  });
}

}  // namespace traverse::gcode
