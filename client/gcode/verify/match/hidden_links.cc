#include "client/gcode/verify/match/hidden_links.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"

namespace traverse::gcode {
namespace {

constexpr double kMostHeightMm = 1;
constexpr double kStepMm = 0.2;

// Half the width of the walls of most printers; of thinner ones, as their filament says.
constexpr double kHalfWidthMm = 0.2;
constexpr double kUsualFilamentMm = 1.75;

// Travel may be nearer to the outer wall that it leaves, so far behind its begin.
constexpr double kLeavingMm = 1.1;

double HalfWidthOf(const LayerShape& shape, double height_mm) {
  constexpr double kArea = std::numbers::pi * kUsualFilamentMm * kUsualFilamentMm / 4;
  return std::min(kHalfWidthMm, shape.filament_per_mm() * kArea / height_mm / 2);
}

bool Adjoin(const LayerShape& below, const LayerShape& above) {
  const double mm = above.z_mm() - below.z_mm();
  return mm > 0 && mm < kMostHeightMm;
}

class HiddenTravel {
 public:
  // With `clearly`: what comes near to where it would be seen is not hidden either.
  HiddenTravel(const LayerShapes& shapes, bool clearly)
      : shapes_(shapes),
        clearly_(clearly),
        half_mm_(HalfWidthOf(shapes.here, shapes.here.z_mm() - shapes.below.z_mm())) {}

  // Whether nobody sees the straight move behind `behind_mm` of travel that left the path at
  // `left`.
  bool Hides(Point left, double behind_mm, Point from, Point to) const {
    if (shapes_.below.MeetsOpenWall(from, to, half_mm_)) return false;
    if (shapes_.above.MeetsOpenWall(from, to, half_mm_)) return false;
    const double length = Distance(from, to);
    const double leaving = shapes_.here.IsNearWall(left, kOnPathMm) ? kLeavingMm - behind_mm : 0;
    const int steps = std::max(static_cast<int>(std::ceil(length / kStepMm)), 1);
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      if (!HidesPoint(Between(from, to, share), share * length < leaving)) return false;
    }
    return true;
  }

 private:
  bool HidesPoint(Point at, bool leaves) const {
    const bool near = shapes_.here.IsNearWall(at, clearly_ ? 2 * half_mm_ : half_mm_);
    if (near ? !leaves : !shapes_.here.IsWithin(at)) return false;
    return Covers(shapes_.below, at) && Covers(shapes_.above, at);
  }

  bool Covers(const LayerShape& shape, Point at) const {
    return shape.IsNearWall(at, half_mm_) ? !clearly_ : shape.IsWithin(at);
  }

  const LayerShapes& shapes_;
  const bool clearly_;
  const double half_mm_;
};

// The moves of `link` behind its first `skipped` ones, if all of it is level open travel; else
// none.
absl::Span<const TraceMove> TravelAlone(const TraceChunk& chunk, uint32_t link, uint32_t skipped) {
  if (chunk.links[link].new_layer || chunk.links[link].scripted) return {};
  const absl::Span<const TraceMove> moves = chunk.MovesOf(link);
  const bool alone = std::ranges::all_of(moves, [](const TraceMove& move) {
    const bool level = move.z_from_mm == move.z_to_mm;
    return move.kind == MoveKind::kTravel && move.open && !move.arc && level;
  });
  return alone ? moves.subspan(skipped) : absl::Span<const TraceMove>();
}

// Whether nobody sees `moves`, which follow each other, are no longer than `longest_mm`, and bend,
// behind the first `along` of them, only if the straight one would not clearly be hidden.
bool Hides(const LayerShapes& shapes, absl::Span<const TraceMove> moves, size_t along,
           double longest_mm) {
  const HiddenTravel travel(shapes, /*clearly=*/false);
  const Point left = moves.front().from;
  double length = 0;
  double along_mm = 0;
  for (size_t i = 0; i < moves.size(); ++i) {
    const TraceMove& move = moves[i];
    if (i == along) along_mm = length;
    if (length + move.length_mm() > longest_mm) return false;
    if (!travel.Hides(left, length, move.from, move.to)) return false;
    length += move.length_mm();
  }
  return moves.size() <= along + 1 ||
         !HiddenTravel(shapes, /*clearly=*/true)
              .Hides(left, along_mm, moves[along].from, moves.back().to);
}

}  // namespace

absl::flat_hash_set<uint32_t> HiddenLinksOf(const LayerPair& layer, const LayerShapes& shapes,
                                            double longest_mm, bool bends) {
  absl::flat_hash_set<uint32_t> links;
  const bool between = Adjoin(shapes.below, shapes.here) && Adjoin(shapes.here, shapes.above);
  if (!between || !shapes.here.one_tool()) return links;
  const Visit* before = nullptr;
  for (const Visit& visit : layer.visits()) {
    if (layer.Ended()) break;
    const Visit* left = std::exchange(before, &visit);
    const uint32_t link = visit.first_path;
    // A path that goes on where the one before it ends has no link of its own.
    const bool begins = layer.is().paths[link].first_segment == visit.first_segment;
    if (left == nullptr || left->last_path + 1 != link || !begins) continue;
    if (layer.Outer(visit.path)) continue;
    const uint32_t tail = layer.Side(false).TailOf(link);
    const absl::Span<const TraceMove> moves = TravelAlone(layer.is(), link, tail);
    if (moves.empty()) continue;
    const size_t along =
        MovesWithin(moves.first(layer.Side(false).AlongOf(link) - tail), kLeavingMm);
    if (moves.size() > along + 1 && !bends) continue;
    if (Hides(shapes, moves, along, longest_mm)) links.insert(link);
  }
  return links;
}

}  // namespace traverse::gcode
