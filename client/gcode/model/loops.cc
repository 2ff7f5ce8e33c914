#include "client/gcode/model/loops.h"

#include <algorithm>

#include "client/gcode/model/segment_grid.h"
#include "client/gcode/text/text.h"

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

// Filament for each mm of way.
double FlowOf(const Block& block) {
  if (!(block.length_mm > 0)) return 0;
  return ToDouble(block.e_out - block.e_in) / static_cast<double>(block.length_mm);
}

// What CuraEngine calls skin.
bool IsCuraSkin(const GcodeFile& file, const Block& block) {
  const uint32_t setter = file.states[block.state_in][kSlotType];
  return setter != 0 && StartsWith(file.setters.Line(setter), ";TYPE:SKIN");
}

// The usual flow of the walls of a layer; 0 if it has none.
double WallFlow(const GcodeFile& file, const Layer& layer, const std::vector<Outline>& outlines) {
  double filament = 0;
  double way = 0;
  for (size_t path = 0; path < outlines.size(); ++path) {
    if (!IsWall(outlines[path].feature)) continue;
    const Block& block = file.blocks[layer.first_block + path];
    filament += ToDouble(block.e_out - block.e_in);
    way += static_cast<double>(block.length_mm);
  }
  return way > 0 ? filament / way : 0;
}

// True if the middle of the first stretch of `outline` lies on a segment of an earlier path.
bool LiesOnEarlier(const Outline& outline, uint32_t path, const SegmentGrid& grid) {
  const Vertex a = outline.points[0];
  const Vertex b = outline.points[1];
  const Vertex middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
  const double reach = 1.1 * outline.width_mm;
  bool lies = false;
  for (const Vertex way : {Vertex{reach, 0}, Vertex{0, reach}}) {
    grid.ForEachOnWay(
        {middle.x - way.x, middle.y - way.y}, {middle.x + way.x, middle.y + way.y},
        [&](uint32_t s) {
          const Segment& other = grid.segments()[s];
          lies = other.path < path && SquaredDistance({middle, middle, 0}, other) <= reach * reach;
          return !lies;
        });
    if (lies) break;
  }
  return lies;
}

// CuraEngine gives ironing the type of the skin that it irons: it is known by its flow, a fraction
// of the usual one, and by lying on skin of the same layer.
void MarkIroning(const GcodeFile& file, const Layer& layer, std::vector<Outline>& outlines) {
  constexpr double kLeastShare = 0.4;
  const double usual = WallFlow(file, layer, outlines);
  std::vector<uint32_t> thin;
  std::vector<Segment> skin;
  for (uint32_t path = 0; path < outlines.size(); ++path) {
    const Block& block = file.blocks[layer.first_block + path];
    if (!IsCuraSkin(file, block)) continue;
    const std::vector<Vertex>& points = outlines[path].points;
    if (FlowOf(block) < kLeastShare * usual) {
      thin.push_back(path);
    } else {
      for (size_t k = 0; k + 1 < points.size(); ++k) {
        skin.push_back({points[k], points[k + 1], path});
      }
    }
  }
  if (thin.empty() || skin.empty()) return;
  const SegmentGrid grid(std::move(skin));
  for (const uint32_t path : thin) {
    if (LiesOnEarlier(outlines[path], path, grid)) outlines[path].feature = Feature::kIroning;
  }
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
  MarkIroning(file, layer, outlines);
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
