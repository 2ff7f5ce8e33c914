#include "client/gcode/loops.h"

#include <algorithm>

#include "client/gcode/segment_grid.h"

namespace traverse::gcode {
namespace {

constexpr size_t kProbes = 16;

// The neighbor's middle is one line further; it may be off by this much of a width.
constexpr double kNeighborSlack = 0.45;

// A point on the right of the middle of segment `k`, where a neighbor would run.
Segment ProbeAt(const Outline& outline, size_t k) {
  const Vertex a = outline.points[k];
  const Vertex b = outline.points[k + 1];
  const Vertex middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
  const double length = Distance(a, b);
  if (!(length > 0)) return {middle, middle, 0};
  const double reach = 0.9 * outline.width_mm / length;
  return {middle, {middle.x + (b.y - a.y) * reach, middle.y - (b.x - a.x) * reach}, 0};
}

bool HasNeighborOutside(const Outline& outline, uint32_t path, const SegmentGrid& grid) {
  const size_t segments = outline.points.size() - 1;
  const size_t step = std::max<size_t>(1, segments / kProbes);
  const double slack = kNeighborSlack * outline.width_mm;
  size_t probes = 0;
  size_t hits = 0;
  for (size_t k = 0; k < segments; k += step) {
    const Segment probe = ProbeAt(outline, k);
    const Segment end{probe.b, probe.b, 0};
    bool hit = false;
    grid.ForEachOnWay(probe.a, probe.b, [&](uint32_t s) {
      const Segment& other = grid.segments()[s];
      hit = other.path != path && SquaredDistance(end, other) <= slack * slack;
      return !hit;
    });
    ++probes;
    hits += hit ? 1 : 0;
  }
  return hits * 2 > probes;
}

}  // namespace

std::vector<Outline> OutlinesOf(const GcodeFile& file, const Layer& layer) {
  std::vector<Outline> outlines;
  std::vector<Segment> loops;
  outlines.reserve(layer.end_block - layer.first_block);
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    outlines.push_back(OutlineOf(file, file.blocks[b]));
    const Outline& outline = outlines.back();
    if (outline.feature != Feature::kLoop) continue;
    for (size_t k = 0; k + 1 < outline.points.size(); ++k) {
      loops.push_back({outline.points[k], outline.points[k + 1], b - layer.first_block});
    }
  }
  if (loops.empty()) return outlines;
  const SegmentGrid grid(std::move(loops));
  for (size_t path = 0; path < outlines.size(); ++path) {
    Outline& outline = outlines[path];
    if (outline.feature != Feature::kLoop) continue;
    if (HasNeighborOutside(outline, static_cast<uint32_t>(path), grid)) {
      outline.feature = Feature::kInnerWall;
    }
  }
  return outlines;
}

}  // namespace traverse::gcode
