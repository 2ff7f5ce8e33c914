#include "client/gcode/choose/revisits.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "client/gcode/choose/box_pairs.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/parallel.h"
#include "client/gcode/plan/policy.h"

namespace traverse::gcode {
namespace {

// Differences smaller than this do not count.
constexpr double kSameSeconds = 1e-6;

double LengthOf(const Outline& outline) {
  double sum = 0;
  for (size_t i = 1; i < outline.points.size(); ++i) {
    const Vertex a = outline.points[i - 1];
    const Vertex b = outline.points[i];
    sum += std::hypot(b.x - a.x, b.y - a.y);
  }
  return sum;
}

}  // namespace

Revisits::Revisits(const GcodeFile& file, double min_seconds, int threads)
    : file_(file), min_seconds_(min_seconds) {
  if (min_seconds <= 0) return;
  layers_.resize(file.layers.size());
  ParallelFor(layers_.size(), threads, [this](size_t i) { layers_[i] = IslandsOf(i); });
  for (size_t i = 1; i < layers_.size(); ++i) {
    layers_[i].over = OverlappingBoxes(layers_[i - 1].boxes, layers_[i].boxes);
  }
}

Revisits::LayerIslands Revisits::IslandsOf(size_t layer) const {
  const LayerPlan plan = MakeLayerPlan(file_, file_.layers[layer], Policy::kSafe);
  LayerIslands islands;
  islands.island = plan.island;
  for (size_t path = 0; path < plan.outlines.size(); ++path) {
    const Outline& outline = plan.outlines[path];
    islands.length.push_back(LengthOf(outline));
    const size_t island = plan.island[path];
    if (islands.boxes.size() <= island) islands.boxes.resize(island + 1);
    for (const Vertex& point : outline.points) islands.boxes[island].Add({point.x, point.y});
  }
  return islands;
}

Revisits::Visits Revisits::VisitsOf(size_t layer, const LayerOrder& order) const {
  const LayerIslands& islands = layers_[layer];
  Visits visits;
  visits.begun.assign(islands.boxes.size(), std::numeric_limits<double>::infinity());
  visits.left.assign(islands.boxes.size(), 0);
  double sum = 0;
  for (const double length : islands.length) sum += length;
  double done = 0;
  for (const Placement& placed : order) {
    const size_t path = placed.block - file_.layers[layer].first_block;
    const size_t island = islands.island[path];
    visits.begun[island] = std::min(visits.begun[island], sum > 0 ? done / sum : 0);
    done += islands.length[path];
    visits.left[island] = sum > 0 ? done / sum : 1;
  }
  return visits;
}

std::vector<double> Revisits::Gaps(size_t layer, const TimedOrder& before,
                                   const TimedOrder& next) const {
  const Visits below = VisitsOf(layer - 1, *before.order);
  const Visits here = VisitsOf(layer, *next.order);
  std::vector<double> gaps;
  for (const auto& [left, begun] : layers_[layer].over) {
    gaps.push_back((1 - below.left[left]) * before.seconds + here.begun[begun] * next.seconds);
  }
  return gaps;
}

bool Revisits::TooSoon(size_t layer, const TimedOrder& before, const TimedOrder& next,
                       const TimedOrder& given_before, const TimedOrder& given_next) const {
  assert(layer > 0);
  if (min_seconds_ <= 0) return false;
  const std::vector<double> gaps = Gaps(layer, before, next);
  const std::vector<double> given = Gaps(layer, given_before, given_next);
  for (size_t i = 0; i < gaps.size(); ++i) {
    if (gaps[i] < std::min(min_seconds_, given[i]) - kSameSeconds) return true;
  }
  return false;
}

}  // namespace traverse::gcode
