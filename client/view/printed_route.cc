#include "client/view/printed_route.h"

#include <cmath>

#include "client/gcode/link.h"

namespace traverse::view {
namespace {

constexpr double kInchMm = 25.4;
constexpr double kSameMm = 1e-3;

bool Same(const Place& a, const Place& b) {
  return std::abs(a.x - b.x) < kSameMm && std::abs(a.y - b.y) < kSameMm;
}

// Places of one layer in mm.
class Places {
 public:
  Places(const GcodeFile& file, const gcode::Layer& layer)
      : unit_(file.modes[file.blocks[layer.first_block].mode].inches ? kInchMm : 1) {}

  Place operator()(const gcode::Position& at) const {
    return {gcode::ToDouble(at.x) * unit_, gcode::ToDouble(at.y) * unit_};
  }

 private:
  double unit_;
};

bool Fits(const GcodeFile& printed, const gcode::Layer& layer, const std::vector<DrawnPath>& paths,
          const std::vector<DrawnVisit>& order) {
  if (layer.end_block - layer.first_block != order.size()) return false;
  const Places place(printed, layer);
  for (size_t i = 0; i < order.size(); ++i) {
    const gcode::Block& block = printed.blocks[layer.first_block + i];
    if (!Same(place(block.first), EntryOf(paths[order[i].path], order[i]))) return false;
  }
  return true;
}

// Where the head comes by on its way to block `index`.
std::vector<Place> Corners(const GcodeFile& file, size_t index, const Places& place) {
  std::vector<Place> corners = {place(file.blocks[index - 1].last)};
  for (const gcode::LinkStep& step : gcode::ReadLink(file, index).steps) {
    if (gcode::IsXyMotion(step.kind)) corners.push_back(place(step.to));
  }
  return corners;
}

}  // namespace

std::vector<DrawnVisit> InOrder(size_t paths) {
  std::vector<DrawnVisit> visits(paths);
  for (size_t i = 0; i < paths; ++i) visits[i].path = i;
  return visits;
}

DrawnRoute PrintedRoute(const GcodeFile& printed, size_t layer, const std::vector<DrawnPath>& paths,
                        const std::vector<std::vector<DrawnVisit>>& orders) {
  const gcode::Layer& blocks = printed.layers[layer];
  const Places place(printed, blocks);
  DrawnRoute route;
  route.visits = orders.front();
  const size_t first = blocks.first_block;
  route.start = place(first > 0 ? printed.blocks[first - 1].last : printed.blocks[first].first);
  for (const std::vector<DrawnVisit>& order : orders) {
    if (!Fits(printed, blocks, paths, order)) continue;
    route.visits = order;
    for (size_t i = 0; i < order.size(); ++i) {
      if (first + i == 0) continue;  // how the start script comes to it is not drawn
      std::vector<Place> corners = Corners(printed, first + i, place);
      const Place entry = EntryOf(paths[order[i].path], order[i]);
      if (!corners.empty() && Same(corners.back(), entry)) corners.pop_back();
      // The layer's start is where the path before ended, so the first corner says it again.
      const Place from = i == 0 ? route.start : ExitOf(paths[order[i - 1].path], order[i - 1]);
      if (!corners.empty() && Same(corners.front(), from)) corners.erase(corners.begin());
      route.visits[i].via = std::move(corners);
    }
    return route;
  }
  return route;
}

}  // namespace traverse::view
