#include "client/gcode/plan/stacked_islands.h"

#include <algorithm>
#include <array>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/island_map.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/parallel.h"
#include "client/gcode/plan/precedence.h"

namespace traverse::gcode {
namespace {

// Layers whose cells are kept at once.
constexpr size_t kBatch = 16;

void AddOutline(const Outline& outline, uint32_t island, IslandMap& map) {
  const std::vector<Point>& points = outline.shape();
  for (size_t i = 1; i < points.size() && !map.full(); ++i) {
    map.AddLine(points[i - 1].x, points[i - 1].y, points[i].x, points[i].y, island);
  }
}

// Adds the islands of layer `layer` to `islands`, and returns their cells, each once.
std::vector<IslandCell> FindIslands(const GcodeFile& file, const Layer& layer,
                                    LayerIslands& islands) {
  const std::vector<Outline> outlines = OutlinesOf(file, layer);
  islands.island = FindContacts(outlines, [](uint32_t, uint32_t) { return false; }).island;
  uint32_t count = 0;
  for (const uint32_t island : islands.island) count = std::max(count, island + 1);
  IslandMap map(count);
  for (size_t path = 0; path < outlines.size(); ++path) {
    AddOutline(outlines[path], islands.island[path], map);
  }
  islands.tree = map.TakeTree();
  return map.TakeCells();
}

// What was printed last in each cell: two islands where their edges meet.
class TopOfPrint {
 public:
  // Layer `layer` of `stack`.
  void Add(uint32_t layer, const std::vector<IslandCell>& cells, std::vector<LayerIslands>& stack) {
    std::vector<Support> supports;
    for (const auto& [cell, island] : cells) {
      const auto found = top_.find(cell);
      if (found == top_.end()) continue;
      for (const uint32_t below : found->second.islands) {
        supports.push_back({found->second.layer, below, island});
      }
    }
    KeepOnce(supports);
    LayerIslands& islands = stack[layer];
    for (const Support& support : supports) {
      IslandTree::ForEachPair(stack[support.layer].tree, support.below, islands.tree,
                              support.island, [&](uint32_t below, uint32_t island) {
                                islands.supports.push_back({support.layer, below, island});
                              });
    }
    KeepOnce(islands.supports);
    for (const auto& [cell, island] : cells) {
      if (top_.size() >= kMostCellsOfPrint && !top_.contains(cell)) continue;
      const auto [at, is_new] = top_.try_emplace(cell);
      Top& top = at->second;
      if (is_new || top.layer != layer) top = {layer, {island, island}};
      top.islands[1] = island;
    }
  }

 private:
  using Support = LayerIslands::Support;

  static void KeepOnce(std::vector<Support>& supports) {
    std::sort(supports.begin(), supports.end());
    supports.erase(std::unique(supports.begin(), supports.end()), supports.end());
  }

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
      stack[begin + i].tree = IslandTree(1);
    });
    for (size_t i = 0; i < count; ++i) {
      top.Add(static_cast<uint32_t>(begin + i), cells[i], stack);
    }
  }
  return stack;
}

}  // namespace traverse::gcode
