#include "client/gcode/verify/match/hidden_links.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace traverse::gcode {
namespace {

constexpr double kMostHeightMm = 1;
constexpr double kStepMm = 0.2;

// Half the width of the walls of most printers; of thinner ones, as their filament says.
constexpr double kHalfWidthMm = 0.2;
constexpr double kUsualFilamentMm = 1.75;

// Travel may be nearer to the outer wall that it leaves, so far behind its begin.
constexpr double kLeavingMm = 1.1;
constexpr double kOnWallMm = 0.05;

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
  explicit HiddenTravel(const LayerShapes& shapes)
      : shapes_(shapes),
        half_mm_(HalfWidthOf(shapes.here, shapes.here.z_mm() - shapes.below.z_mm())) {}

  bool Hides(Point from, Point to) const {
    if (shapes_.below.MeetsOpenWall(from, to, half_mm_)) return false;
    if (shapes_.above.MeetsOpenWall(from, to, half_mm_)) return false;
    const double length = DistanceOf(from, to);
    const double leaving = shapes_.here.IsNearWall(from, kOnWallMm) ? kLeavingMm : 0;
    const int steps = std::max(static_cast<int>(std::ceil(length / kStepMm)), 1);
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const Point at{from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share};
      if (!HidesPoint(at, share * length < leaving)) return false;
    }
    return true;
  }

 private:
  bool HidesPoint(Point at, bool leaves) const {
    const bool near = shapes_.here.IsNearWall(at, half_mm_);
    if (near ? !leaves : !shapes_.here.IsWithin(at)) return false;
    return Covers(shapes_.below, at) && Covers(shapes_.above, at);
  }

  bool Covers(const LayerShape& shape, Point at) const {
    return shape.IsWithin(at) || shape.IsNearWall(at, half_mm_);
  }

  const LayerShapes& shapes_;
  const double half_mm_;
};

// The only move of `link` behind its first `skipped` ones, if it is level open travel.
const TraceMove* TravelAlone(const TraceChunk& chunk, uint32_t link, uint32_t skipped) {
  const TraceLink& traced = chunk.links[link];
  if (traced.new_layer || traced.scripted || traced.first_move + skipped + 1 != traced.end_move) {
    return nullptr;
  }
  for (uint32_t m = traced.first_move; m < traced.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    const bool level = move.z_from_mm == move.z_to_mm;
    if (move.kind != MoveKind::kTravel || !move.open || move.arc || !level) return nullptr;
  }
  return &chunk.moves[traced.end_move - 1];
}

}  // namespace

absl::flat_hash_set<uint32_t> HiddenLinksOf(const LayerPair& layer, const LayerShapes& shapes,
                                            double longest_mm) {
  absl::flat_hash_set<uint32_t> links;
  const bool between = Adjoin(shapes.below, shapes.here) && Adjoin(shapes.here, shapes.above);
  if (!between || !shapes.here.one_tool()) return links;
  const HiddenTravel travel(shapes);
  const Visit* before = nullptr;
  for (const Visit& visit : layer.visits()) {
    const Visit* left = std::exchange(before, &visit);
    const uint32_t link = visit.first_path;
    // A path that goes on where the one before it ends has no link of its own.
    const bool begins = layer.is().paths[link].first_segment == visit.first_segment;
    if (left == nullptr || left->last_path + 1 != link || !begins) continue;
    if (layer.Outer(visit.path)) continue;
    const uint32_t tail =
        LayerPair::TailMoves(layer.is(), left->last_path, layer.PiecesOf(left->path));
    const TraceMove* move = TravelAlone(layer.is(), link, tail);
    if (move == nullptr || move->length_mm() > longest_mm) continue;
    if (travel.Hides(move->from, move->to)) links.insert(link);
  }
  return links;
}

}  // namespace traverse::gcode
