#include "client/gcode/model/loops.h"

#include <algorithm>

#include "client/gcode/model/block_feature.h"
#include "client/gcode/model/ironing.h"
#include "client/gcode/model/segment_grid.h"

namespace traverse::gcode {
namespace {

constexpr size_t kProbes = 24;

// The neighbor's middle is a width away, or somewhat more. The verifier looks as far as 0.9 mm.
constexpr double kReachWidths = 1.35;
constexpr double kMostReachMm = 0.85;

// A line on the right of the middle of segment `k`, which a neighbor would cross.
Segment ProbeAt(const Outline& outline, size_t k) {
  const Point a = outline.shape()[k];
  const Point b = outline.shape()[k + 1];
  const Point middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
  const double length = Distance(a, b);
  if (!(length > 0)) return {middle, middle, 0};
  const double reach = std::min(kReachWidths * outline.width_mm, kMostReachMm) / length;
  return {middle, {middle.x + (b.y - a.y) * reach, middle.y - (b.x - a.x) * reach}, 0};
}

// The length of the segments looked at: of those with a neighbor, and of all.
struct Probes {
  double beside_mm = 0;
  double all_mm = 0;

  // Along most of the outside. The verifier measures otherwise, and half of it is its limit.
  bool IsInner() const {
    constexpr double kMost = 0.6;
    return beside_mm > kMost * all_mm;
  }
};

void ProbeOutside(const Outline& outline, uint32_t loop, const SegmentGrid& grid, size_t& looks,
                  Probes& probes) {
  const size_t segments = outline.shape().size() - 1;
  const size_t step = std::max<size_t>(1, segments / kProbes);
  for (size_t k = 0; k < segments; k += step) {
    const Segment probe = ProbeAt(outline, k);
    bool hit = false;
    grid.ForEachOnTravel(probe.a, probe.b, looks, [&](uint32_t s) {
      const Segment& other = grid.segments()[s];
      hit = other.path != loop && Cross(probe.a, probe.b, other.a, other.b);
      return !hit;
    });
    const double length = Distance(outline.shape()[k], outline.shape()[k + 1]);
    probes.all_mm += length;
    if (hit) probes.beside_mm += length;
  }
}

// A loop that ends short of its start, and that was begun elsewhere, is two paths with the gap
// between them.
bool AreLoopInTwo(const GcodeFile& file, const Layer& layer, const std::vector<Outline>& outlines,
                  size_t path) {
  constexpr double kSameMm = 1e-3;
  const Outline& one = outlines[path];
  const Outline& other = outlines[path + 1];
  if (one.is_loop || other.is_loop || one.feature != other.feature ||
      one.shape().size() + other.shape().size() < 5 ||
      Distance(one.points.back(), other.points.front()) > LoopGapMm(file, one.width_mm) ||
      Distance(other.points.back(), one.points.front()) > kSameMm) {
    return false;
  }
  const size_t block = layer.first_block + path;
  return FeatureOf(file, file.blocks[block], true) == Feature::kLoop &&
         FeatureOf(file, file.blocks[block + 1], true) == Feature::kLoop;
}

// Loops without a name: those that have another one along most of their outside are inner walls.
void TellWalls(const GcodeFile& file, const Layer& layer, std::vector<Outline>& outlines) {
  std::vector<uint32_t> loops;  // the first path of each; its second one follows, if it has two
  std::vector<bool> in_two(outlines.size(), false);
  std::vector<Segment> segments;
  for (uint32_t path = 0; path < outlines.size(); ++path) {
    in_two[path] = path + 1 < outlines.size() && AreLoopInTwo(file, layer, outlines, path);
    if (!in_two[path] && outlines[path].feature != Feature::kLoop) continue;
    loops.push_back(path);
    AddSegments(outlines[path].shape(), path, segments);
    if (!in_two[path]) continue;
    AddSegments(outlines[path + 1].shape(), path, segments);
    outlines[path].feature = outlines[path + 1].feature = Feature::kLoop;
    ++path;
  }
  if (loops.empty()) return;
  const SegmentGrid grid(std::move(segments));
  size_t looks = SegmentGrid::kLooksPerSegment * grid.segments().size();
  for (const uint32_t loop : loops) {
    Probes probes;
    ProbeOutside(outlines[loop], loop, grid, looks, probes);
    if (in_two[loop]) ProbeOutside(outlines[loop + 1], loop, grid, looks, probes);
    if (looks == 0) break;  // the others stay as they are named
    if (!probes.IsInner()) continue;
    outlines[loop].feature = Feature::kInnerWall;
    if (in_two[loop]) outlines[loop + 1].feature = Feature::kInnerWall;
  }
}

}  // namespace

std::vector<Outline> OutlinesOf(const GcodeFile& file, const Layer& layer) {
  std::vector<Outline> outlines;
  outlines.reserve(layer.end_block - layer.first_block);
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    outlines.push_back(OutlineOf(file, file.blocks[b]));
  }
  MarkIroning(file, layer, outlines);
  TellWalls(file, layer, outlines);
  return outlines;
}

}  // namespace traverse::gcode
