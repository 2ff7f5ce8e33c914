#include "client/view/scene/drawn_arcs.h"

#include <string_view>
#include <utility>
#include <vector>

#include "client/gcode/model/arc.h"
#include "client/gcode/model/outline.h"

namespace traverse::view {
namespace {

// As fine as the report's grid.
constexpr double kToleranceMm = 0.02;

// [segment of the block] the points between its ends; empty if no segment has any.
std::vector<std::vector<Point>> PointsOnArcs(const GcodeFile& file, const gcode::Block& block) {
  const double unit = file.modes[block.mode].UnitMm();
  std::vector<std::vector<Point>> on_arcs;
  bool any = false;
  gcode::Interpreter interpreter(std::string_view(file.text).substr(0, block.end), block.begin,
                                 gcode::StateAt(file, block));
  for (gcode::Step step; interpreter.Next(step);) {
    if (step.kind != gcode::StepKind::kExtrude && step.kind != gcode::StepKind::kZeroExtrude) {
      continue;
    }
    std::vector<Point>& points = on_arcs.emplace_back();
    if (!step.arc) continue;
    points = gcode::ArcPoints(step.command, step.from, interpreter.state().at, unit, kToleranceMm);
    any = any || !points.empty();
  }
  if (!any) on_arcs.clear();
  return on_arcs;
}

// Inserts the points into the path. Returns the new positions of its vertices.
std::vector<size_t> Bend(const std::vector<std::vector<Point>>& on_arcs, DrawnPath& path) {
  std::vector<DrawnPoint> bent;
  std::vector<size_t> moved_to;
  for (size_t i = 0; i < path.points.size(); ++i) {
    moved_to.push_back(bent.size());
    bent.push_back(path.points[i]);
    if (i >= on_arcs.size()) continue;
    for (const Point& at : on_arcs[i]) bent.push_back({at.x, at.y});
  }
  path.points = std::move(bent);
  return moved_to;
}

}  // namespace

void DrawArcs(const GcodeFile& file, size_t layer, DrawnLayer& drawn) {
  std::vector<std::vector<size_t>> moved_to(drawn.paths.size());
  const uint32_t first = file.layers[layer].first_block;
  for (size_t i = 0; i < drawn.paths.size(); ++i) {
    const auto on_arcs = PointsOnArcs(file, file.blocks[first + i]);
    if (!on_arcs.empty()) moved_to[i] = Bend(on_arcs, drawn.paths[i]);
  }
  for (DrawnRoute& route : drawn.routes) {
    for (DrawnVisit& visit : route.visits) {
      const std::vector<size_t>& entries = moved_to[visit.path];
      if (drawn.paths[visit.path].closed && !entries.empty()) visit.entry = entries[visit.entry];
    }
  }
}

}  // namespace traverse::view
