#include "client/gcode/verify/match/layer_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traverse::gcode {
namespace {

constexpr double kLeastRowMm = 0.2;

// Pieces may be entered in so many rows each, on the average.
constexpr double kRowsOfPiece = 4;

bool UsesOneTool(const LayerPair& layer) {
  if (layer.end_path_was() - layer.first_path_was() < 2) return true;
  const absl::Span<const TraceMove> moves =
      layer.was().MovesOfLinks(layer.first_path_was() + 1, layer.end_path_was());
  return std::ranges::all_of(
      moves, [&moves](const TraceMove& move) { return move.tool == moves.front().tool; });
}

}  // namespace

LayerShape::LayerShape(const LayerPair& layer) {
  const TraceChunk& was = layer.was();
  z_mm_ = was.paths[layer.first_path_was()].z_mm;
  one_tool_ = UsesOneTool(layer);
  std::vector<Piece> walls;
  std::vector<Piece> open_walls;
  double filament = 0;
  double length = 0;
  double rise = 0;  // of all pieces of rounds_
  for (uint32_t path = layer.first_path_was(); path < layer.end_path_was(); ++path) {
    if (!layer.Outer(path)) continue;
    filament += was.paths[path].filament_mm;
    length += was.paths[path].length_mm;
    const absl::Span<const Piece> pieces = layer.PiecesOf(path);
    walls.insert(walls.end(), pieces.begin(), pieces.end());
    if (!layer.Closed(path)) {
      open_walls.insert(open_walls.end(), pieces.begin(), pieces.end());
      continue;
    }
    rounds_.insert(rounds_.end(), pieces.begin(), pieces.end());
    rounds_.push_back({pieces.back().b, pieces.front().a, path});
  }
  filament_per_mm_ = length > 0 ? filament / length : 0;
  walls_ = PieceTree(std::move(walls));
  open_walls_ = PieceTree(std::move(open_walls));
  if (rounds_.empty()) return;
  double high_y = rounds_[0].a.y;
  low_y_ = high_y;
  for (const Piece& piece : rounds_) {
    low_y_ = std::min({low_y_, piece.a.y, piece.b.y});
    high_y = std::max({high_y, piece.a.y, piece.b.y});
    rise += std::abs(piece.a.y - piece.b.y);
  }
  const auto count = static_cast<double>(rounds_.size());
  row_mm_ = std::max({kLeastRowMm, rise / (kRowsOfPiece * count), (high_y - low_y_) / (4 * count)});
  rows_.resize(static_cast<size_t>((high_y - low_y_) / row_mm_) + 1);
  for (uint32_t i = 0; i < rounds_.size(); ++i) {
    const auto [low, high] = std::minmax(rounds_[i].a.y, rounds_[i].b.y);
    for (size_t row = RowOf(low); row <= RowOf(high); ++row) rows_[row].push_back(i);
  }
}

size_t LayerShape::RowOf(double y) const {
  const double row = std::clamp((y - low_y_) / row_mm_, 0.0, static_cast<double>(rows_.size() - 1));
  return static_cast<size_t>(row);
}

bool LayerShape::IsWithin(Point p) const {
  if (rows_.empty()) return false;
  bool within = false;
  for (const uint32_t i : rows_[RowOf(p.y)]) {
    const auto& [a, b, path] = rounds_[i];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) > p.x) within = !within;
  }
  return within;
}

bool LayerShape::IsNearWall(Point p, double reach) const {
  return walls_.AnyNear(
      p, p, reach, [&](const Piece& wall) { return DistanceToPiece(p, wall.a, wall.b) < reach; });
}

bool LayerShape::MeetsOpenWall(Point a, Point b, double reach) const {
  return open_walls_.AnyNear(a, b, reach, [&](const Piece& wall) {
    return DistanceOfPieces(a, b, wall.a, wall.b) < reach;
  });
}

}  // namespace traverse::gcode
