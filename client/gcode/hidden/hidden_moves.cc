#include "client/gcode/hidden/hidden_moves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "client/gcode/hidden/layer_cover.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/parallel.h"

namespace traverse::gcode {
namespace {

// Layers are thinner; what lies farther above or below is another object's.
constexpr double kMostHeightMm = 1;

// So far from its begin a move may be near the wall that it leaves.
constexpr double kLeavingMm = 1;

bool Adjoin(const GcodeFile& file, size_t below, size_t above) {
  const double mm = file.HeightMm(file.layers[above]) - file.HeightMm(file.layers[below]);
  return mm > 0 && mm < kMostHeightMm;
}

// What oozes from one tool shows in what another one prints.
bool HasOneTool(const GcodeFile& file, const Layer& layer) {
  const auto tool_of = [&file](uint32_t block) { return file.modes[file.blocks[block].mode].tool; };
  for (uint32_t b = layer.first_block + 1; b < layer.end_block; ++b) {
    if (tool_of(b) != tool_of(layer.first_block)) return false;
  }
  return true;
}

}  // namespace

HiddenMoves::HiddenMoves(const GcodeFile& file, double longest_mm, int threads)
    : longest_mm_(longest_mm), layers_(file.layers.size()) {
  // The layers beside those of a run are looked at twice.
  constexpr size_t kRun = 16;
  ParallelFor((layers_.size() + kRun - 1) / kRun, threads, [&](size_t run) {
    Fill(file, run * kRun, std::min((run + 1) * kRun, layers_.size()));
  });
}

HiddenMoves::HiddenMoves(const GcodeFile& file, double longest_mm,
                         const std::vector<size_t>& layers)
    : longest_mm_(longest_mm), layers_(file.layers.size()) {
  for (const size_t layer : layers) Fill(file, layer, layer + 1);
}

void HiddenMoves::Fill(const GcodeFile& file, size_t first, size_t end) {
  const auto cover_of = [&](size_t layer) { return CoverOf(OutlinesOf(file, file.layers[layer])); };
  LayerCover below;
  LayerCover here;
  if (first > 0) below = cover_of(first - 1);
  if (first < end) here = cover_of(first);
  for (size_t layer = first; layer < end; ++layer) {
    LayerCover above;
    if (layer + 1 < layers_.size()) above = cover_of(layer + 1);
    const bool between = layer > 0 && layer + 1 < layers_.size() &&
                         Adjoin(file, layer - 1, layer) && Adjoin(file, layer, layer + 1);
    if (between && !here.empty() && HasOneTool(file, file.layers[layer])) {
      CellRows hidden = here.inside;
      CellRows leaving = here.cover;
      leaving.Intersect(here.near);
      for (CellRows* cells : {&hidden, &leaving}) {
        cells->Intersect(below.cover);
        cells->Intersect(above.cover);
      }
      layers_[layer] = {CellTiles(hidden), CellTiles(leaving)};
    }
    below = std::move(here);
    here = std::move(above);
  }
}

bool HiddenMoves::Hides(size_t layer, Point a, Point b, bool leaves_wall) const {
  const double length = Distance(a, b);
  if (!(length <= longest_mm_)) return false;
  const LayerTiles& tiles = layers_[layer];
  const Point from{a.x / kCoverCellMm, a.y / kCoverCellMm};
  const Point to{b.x / kCoverCellMm, b.y / kCoverCellMm};
  // Farther off no layer has cells.
  constexpr double kFar = 1 << 29;
  for (const double at : {from.x, from.y, to.x, to.y}) {
    if (!(std::abs(at) < kFar)) return false;
  }
  // From cell to cell: shares of the move at which it enters the next column and row.
  constexpr double kNever = std::numeric_limits<double>::infinity();
  struct Axis {
    int at;
    int end;
    int step;
    double next;
    double per_cell;
  };
  const auto axis_of = [](double begin, double behind) {
    Axis axis{static_cast<int>(std::floor(begin)), static_cast<int>(std::floor(behind)), 0, kNever,
              kNever};
    if (axis.at == axis.end) return axis;
    axis.step = axis.at < axis.end ? 1 : -1;
    axis.per_cell = 1 / std::abs(behind - begin);
    const double edge = axis.at + (axis.step > 0 ? 1 : 0);
    axis.next = std::abs(edge - begin) * axis.per_cell;
    return axis;
  };
  Axis x = axis_of(from.x, to.x);
  Axis y = axis_of(from.y, to.y);
  double share = 0;
  bool leaves = leaves_wall;
  for (;;) {
    if (tiles.hidden.Has(x.at, y.at)) {
      leaves = false;
    } else if (!leaves || share * length > kLeavingMm || !tiles.leaving.Has(x.at, y.at)) {
      return false;
    }
    if (x.at == x.end && y.at == y.end) return !leaves;
    Axis& axis = x.at == x.end || (y.at != y.end && y.next < x.next) ? y : x;
    share = axis.next;
    axis.at += axis.step;
    axis.next += axis.per_cell;
  }
}

}  // namespace traverse::gcode
