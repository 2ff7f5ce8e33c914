#include "client/gcode/model/ironing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "client/gcode/dialects/dialect.h"
#include "client/gcode/model/segment_grid.h"

namespace traverse::gcode {
namespace {

// Skin deposits at least this share of what fills its layer; slicers iron with half of it at most.
constexpr double kLeastFilled = 0.6;

bool IsSkinOrIroning(const GcodeFile& file, const Block& block) {
  return MayBeIroning(TypeOf(file, block));
}

double FilamentMm(const GcodeFile& file, const Block& block) {
  return ToDouble(block.e_out - block.e_in) * file.modes[block.mode].UnitMm();
}

// Filament per mm of length.
double FlowOf(const GcodeFile& file, const Block& block) {
  return block.length_mm > 0 ? FilamentMm(file, block) / static_cast<double>(block.length_mm) : 0;
}

// The flow that half of the filament of walls and skin is laid with, or less. Ironing has too
// little filament to matter.
double UsualFlow(const GcodeFile& file, const Layer& layer, const std::vector<Outline>& outlines) {
  std::vector<std::pair<double, double>> flows;  // flow, filament
  double filament = 0;
  for (size_t path = 0; path < outlines.size(); ++path) {
    const Block& block = file.blocks[layer.first_block + path];
    if (!IsWall(outlines[path].feature) && !IsSkinOrIroning(file, block)) continue;
    flows.emplace_back(FlowOf(file, block), FilamentMm(file, block));
    filament += flows.back().second;
  }
  std::sort(flows.begin(), flows.end());
  for (const auto& [flow, amount] : flows) {
    filament -= 2 * amount;
    if (filament <= 0) return flow;
  }
  return 0;
}

// The distance of lines of the usual flow that fill the layer.
double UsualSpacingMm(const GcodeFile& file, const Layer& layer, double usual_flow) {
  const double diameter = file.profile.filament_diameter;
  const double height = layer.height_mm;
  return usual_flow * diameter * diameter * std::numbers::pi / 4 / height;
}

// How far from `p` in the direction `to`, of length 1, the segment lies; none if it does not cross
// that line nearly at a right angle.
std::optional<double> DistanceAlong(Point p, Point to, const Segment& segment) {
  const Point side{segment.b.x - segment.a.x, segment.b.y - segment.a.y};
  const double cross = to.x * side.y - to.y * side.x;
  constexpr double kParallel = 0.9;  // sine of the angle between `to` and the segment
  if (std::abs(cross) < kParallel * std::hypot(side.x, side.y) || cross == 0) return std::nullopt;
  const Point from{segment.a.x - p.x, segment.a.y - p.y};
  const double along = (from.x * to.y - from.y * to.x) / cross;
  if (along < 0 || along > 1) return std::nullopt;
  return (from.x * side.y - from.y * side.x) / cross;
}

// The distance from `p`, which lies on the segment from `a` to `b`, to the nearest line beside it;
// `most` if none is as near.
double RoomAt(Point p, Point a, Point b, double most, const SegmentGrid& grid, size_t& looks) {
  const double length = Distance(a, b);
  double room = most;
  for (const double side : {1.0, -1.0}) {
    const Point to{side * (a.y - b.y) / length, side * (b.x - a.x) / length};
    grid.ForEachOnTravel(p, {p.x + most * to.x, p.y + most * to.y}, looks, [&](uint32_t s) {
      const double distance = DistanceAlong(p, to, grid.segments()[s]).value_or(most);
      constexpr double kItselfMm = 0.005;
      if (distance > kItselfMm) room = std::min(room, distance);
      return true;
    });
  }
  return room;
}

// The usual distance between the path and the lines beside it: the median at points along it.
double RoomOf(const Outline& outline, double most, const SegmentGrid& grid, size_t& looks) {
  constexpr int kPoints = 16;
  const std::vector<Point>& points = outline.shape();
  const double length = LengthMm(points);
  std::vector<double> rooms;
  double at = 0;
  for (size_t k = 0; k + 1 < points.size(); ++k) {
    const Point a = points[k];
    const Point b = points[k + 1];
    const double own = Distance(a, b);
    const double next = (static_cast<double>(rooms.size()) + 0.5) / kPoints * length;
    at += own;
    if (at < next || !(own > 0)) continue;
    rooms.push_back(RoomAt({(a.x + b.x) / 2, (a.y + b.y) / 2}, a, b, most, grid, looks));
    // A long segment counts as often as points fall on it.
    while ((static_cast<double>(rooms.size()) + 0.5) / kPoints * length <= at) {
      rooms.push_back(rooms.back());
    }
  }
  if (rooms.empty()) return most;
  std::nth_element(rooms.begin(), rooms.begin() + static_cast<ptrdiff_t>(rooms.size() / 2),
                   rooms.end());
  return rooms[rooms.size() / 2];
}

}  // namespace

void MarkIroning(const GcodeFile& file, const Layer& layer, std::vector<Outline>& outlines) {
  std::vector<uint32_t> thin;
  std::vector<Segment> lines;
  double usual = -1;
  for (uint32_t path = 0; path < outlines.size(); ++path) {
    const Block& block = file.blocks[layer.first_block + path];
    if (!IsSkinOrIroning(file, block)) continue;
    if (usual < 0) usual = UsualFlow(file, layer, outlines);
    if (FlowOf(file, block) >= kLeastFilled * usual) continue;
    thin.push_back(path);
    AddSegments(outlines[path].shape(), path, lines);
  }
  if (thin.empty()) return;
  // Wider than any nozzle: what numbers may say, but nobody looks for that far.
  constexpr double kMostSpacingMm = 100;
  const double spacing = std::min(UsualSpacingMm(file, layer, usual), kMostSpacingMm);
  const SegmentGrid grid(std::move(lines));
  size_t looks = SegmentGrid::kLooksPerSegment * grid.segments().size();
  for (const uint32_t path : thin) {
    const double share = FlowOf(file, file.blocks[layer.first_block + path]) / usual;
    // A line by itself has the room of one of the usual flow.
    const double room = RoomOf(outlines[path], spacing, grid, looks);
    if (share * spacing < kLeastFilled * room) outlines[path].feature = Feature::kIroning;
  }
}

}  // namespace traverse::gcode
