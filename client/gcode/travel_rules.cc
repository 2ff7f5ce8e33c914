#include "client/gcode/travel_rules.h"

#include <algorithm>

#include "client/gcode/loops.h"

namespace traverse::gcode {
namespace {

// Ways begin and end at the middle of a line, which may be a wall itself or lie against one.
constexpr double kEndSlackMm = 0.25;

// Layers from which habits are learnt.
constexpr size_t kSampledLayers = 24;

Vertex Behind(const Block& block, double unit) {
  return {ToDouble(block.last.x) * unit, ToDouble(block.last.y) * unit};
}

bool IsVisibleWall(Feature feature) {
  return feature == Feature::kOuterWall || feature == Feature::kLoop ||
         feature == Feature::kOverhangWall;
}

void LearnLayer(const GcodeFile& file, const Layer& layer, RetractionHabit& habit) {
  const std::vector<Outline> outlines = OutlinesOf(file, layer);
  const VisibleWalls walls(outlines);
  for (uint32_t b = layer.first_block + 1; b < layer.end_block; ++b) {
    const Block& block = file.blocks[b];
    if ((block.link & (kLinkFixed | kLinkSplits)) != 0) continue;
    const Outline& outline = outlines[b - layer.first_block];
    const double unit = file.modes[block.mode].inches ? 25.4 : 1;
    const Vertex from = Behind(file.blocks[b - 1], unit);
    const Vertex to = outline.points.front();
    if (Distance(from, to) < habit.threshold_mm || walls.Crossed(from, to)) continue;
    RetractionCount& count = habit.inside[static_cast<size_t>(outline.feature)];
    ++((block.link & kLinkRetracts) != 0 ? count.retracted : count.not_retracted);
  }
}

}  // namespace

VisibleWalls::VisibleWalls(const std::vector<Outline>& outlines)
    : grid_([&outlines] {
        std::vector<Segment> segments;
        for (size_t path = 0; path < outlines.size(); ++path) {
          const Outline& outline = outlines[path];
          if (!IsVisibleWall(outline.feature)) continue;
          const size_t n = outline.points.size();
          for (size_t k = 0; k + 1 < n; ++k) {
            segments.push_back(
                {outline.points[k], outline.points[k + 1], static_cast<uint32_t>(path)});
          }
          if (outline.closed && !outline.exactly_closed) {
            segments.push_back(
                {outline.points[n - 1], outline.points[0], static_cast<uint32_t>(path)});
          }
        }
        return segments;
      }()) {}

bool VisibleWalls::Crossed(Vertex a, Vertex b) const {
  const double length = Distance(a, b);
  const double cut = std::min(kEndSlackMm, length * 0.2) / std::max(length, 1e-9);
  const Vertex from{a.x + (b.x - a.x) * cut, a.y + (b.y - a.y) * cut};
  const Vertex to{b.x - (b.x - a.x) * cut, b.y - (b.y - a.y) * cut};
  bool crossed = false;
  grid_.ForEachOnWay(from, to, [&](uint32_t s) {
    const Segment& wall = grid_.segments()[s];
    crossed = Cross(from, to, wall.a, wall.b);
    return !crossed;
  });
  return crossed;
}

RetractionHabit LearnRetraction(const GcodeFile& file, double threshold_mm) {
  RetractionHabit habit;
  habit.threshold_mm = threshold_mm;
  for (const Block& block : file.blocks) {
    habit.retracts = habit.retracts || (block.link & kLinkRetracts) != 0;
  }
  const size_t step = std::max<size_t>(1, file.layers.size() / kSampledLayers);
  for (size_t i = 0; habit.retracts && i < file.layers.size(); i += step) {
    LearnLayer(file, file.layers[i], habit);
  }
  for (const RetractionCount& count : habit.inside) {
    habit.crossing_matters = habit.crossing_matters || !count.Mostly();
  }
  return habit;
}

TravelRules::TravelRules(const RetractionHabit& habit, const std::vector<Outline>& outlines)
    : habit_(habit) {
  if (habit.crossing_matters) walls_ = std::make_unique<const VisibleWalls>(outlines);
}

bool TravelRules::Retracts(Vertex a, Vertex b, Feature feature) const {
  if (!habit_.retracts || Distance(a, b) < habit_.threshold_mm) return false;
  if (walls_ == nullptr || habit_.inside[static_cast<size_t>(feature)].Mostly()) return true;
  return walls_->Crossed(a, b);
}

}  // namespace traverse::gcode
