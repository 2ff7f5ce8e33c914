#include "client/gcode/plan/stacked_islands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/island_cells.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/parallel.h"
#include "client/gcode/plan/precedence.h"

namespace traverse::gcode {
namespace {

// Points along a path are at most half a cell apart, so that no cell of it is missed but for
// corners.
constexpr double kStepCells = 0.5;

// Paths whose middles are closer than this are of one island: heat passes between them.
constexpr double kIslandsApartMm = 1;

// Layers whose cells are kept at once.
constexpr size_t kBatch = 16;

void AddCells(const Outline& outline, uint32_t island, IslandCells& cells) {
  const std::vector<Vertex>& points = outline.shape();
  const auto add = [&](double x, double y) { cells.Add({CellAt(x, y), island}); };
  if (!points.empty()) add(points[0].x, points[0].y);
  for (size_t i = 1; i < points.size(); ++i) {
    const double dx = points[i].x - points[i - 1].x;
    const double dy = points[i].y - points[i - 1].y;
    const double steps =
        std::clamp(std::ceil(std::hypot(dx, dy) / kStepCells), 1.0, kFarCells / kStepCells);
    for (double step = 1; step <= steps && !cells.full(); ++step) {
      add(points[i - 1].x + dx * step / steps, points[i - 1].y + dy * step / steps);
    }
  }
}

// Adds the islands of layer `layer` to `islands`, and returns their cells, each once.
std::vector<IslandCell> FindIslands(const GcodeFile& file, const Layer& layer,
                                    LayerIslands& islands) {
  std::vector<Outline> outlines = OutlinesOf(file, layer);
  for (Outline& outline : outlines) {
    outline.width_mm = std::max(outline.width_mm, kIslandsApartMm / kTouch);
  }
  islands.island = FindContacts(outlines, [](uint32_t, uint32_t) { return false; }).island;
  IslandCells cells;
  for (size_t path = 0; path < outlines.size(); ++path) {
    islands.count = std::max(islands.count, islands.island[path] + 1);
    AddCells(outlines[path], islands.island[path], cells);
  }
  return cells.Take();
}

// What was printed last in each cell: two islands where their edges meet.
class TopOfPrint {
 public:
  void Add(uint32_t layer, const std::vector<IslandCell>& cells, LayerIslands& islands) {
    for (const auto& [cell, island] : cells) {
      const auto found = top_.find(cell);
      if (found == top_.end()) continue;
      for (const uint32_t below : found->second.islands) {
        islands.supports.push_back({found->second.layer, below, island});
      }
    }
    std::sort(islands.supports.begin(), islands.supports.end());
    islands.supports.erase(std::unique(islands.supports.begin(), islands.supports.end()),
                           islands.supports.end());
    for (const auto& [cell, island] : cells) {
      if (top_.size() >= kMostCellsOfPrint && !top_.contains(cell)) continue;
      const auto [at, is_new] = top_.try_emplace(cell);
      Top& top = at->second;
      if (is_new || top.layer != layer) top = {layer, {island, island}};
      top.islands[1] = island;
    }
  }

 private:
  struct Top {
    uint32_t layer = 0;
    std::array<uint32_t, 2> islands{};
  };

  absl::flat_hash_map<uint64_t, Top> top_;
};

}  // namespace

std::vector<LayerIslands> StackIslands(const GcodeFile& file, int threads) {
  std::vector<LayerIslands> stack(file.layers.size());
  TopOfPrint top;
  std::vector<std::vector<IslandCell>> cells(kBatch);
  for (size_t begin = 0; begin < stack.size(); begin += kBatch) {
    const size_t count = std::min(kBatch, stack.size() - begin);
    ParallelFor(count, threads, [&](size_t i) {
      const Layer& layer = file.layers[begin + i];
      if (!file.limit.Ended()) {
        cells[i] = FindIslands(file, layer, stack[begin + i]);
        return;
      }
      // What is made of it is not looked at.
      cells[i].clear();
      stack[begin + i].island.assign(layer.end_block - layer.first_block, 0);
      stack[begin + i].count = 1;
    });
    for (size_t i = 0; i < count; ++i) {
      top.Add(static_cast<uint32_t>(begin + i), cells[i], stack[begin + i]);
    }
  }
  return stack;
}

}  // namespace traverse::gcode
