// The shape of a block's path.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_OUTLINE_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_OUTLINE_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "client/gcode/model/block_feature.h"
#include "client/gcode/model/gcode_file.h"
#include "engine/model/point.h"

namespace traverse::gcode {

struct Outline {
  // The ends of its extruding segments, in the file's order: n + 1 for n segments. An arc is one
  // segment.
  std::vector<Point> points;

  // The same with points on its arcs, near enough to replace them by lines; empty if it has
  // none.
  std::vector<Point> bent;

  // The printed shape, which does not say where the path may begin.
  const std::vector<Point>& shape() const { return bent.empty() ? points : bent; }

  // Its shape ends where it began, or no more than LoopGapMm short of it.
  bool is_loop = false;

  // A loop that is printed as one. It may begin at any of its points, or only at the first one: so
  // does a circle of one or two arcs, or a tiny one.
  bool closed = false;
  bool one_start = false;

  Feature feature = Feature::kLine;
  double width_mm = 0.45;  // of the deposited line, as the file says or its E words imply
};

// Along lines between the points.
double LengthMm(absl::Span<const Point> points);

// How far short of its start a loop with lines of this width may end: slicers clip up to 0.15
// widths of the nozzle or of the line, and CuraEngine's coasting leaves 0.09 mm.
double LoopGapMm(const GcodeFile& file, double width_mm);

Outline OutlineOf(const GcodeFile& file, const Block& block);

// The machine as it is when `block` begins.
MachineState StateAt(const GcodeFile& file, const Block& block);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_OUTLINE_H_
