#include "engine/weller/steps/raster_route.h"

#include <cstddef>

namespace traverse {

std::vector<RasterGroup> GroupRasters(const IslandLayout& layout, const std::vector<int>& rasters) {
  std::vector<RasterGroup> groups;
  std::vector<int> group_of(layout.islands.size(), -1);
  for (const int raster : rasters) {
    const int island = layout.island_of[static_cast<size_t>(raster)];
    int& group = group_of[static_cast<size_t>(island)];
    if (group < 0) {
      group = static_cast<int>(groups.size());
      groups.push_back({island, {}});
    }
    groups[static_cast<size_t>(group)].rasters.push_back(raster);
  }
  return groups;
}

bool KeepsIslandsTogether(const IslandLayout& layout, const Route& rasters) {
  std::vector<bool> left(layout.islands.size());
  for (size_t k = 1; k < rasters.size(); ++k) {
    const size_t before =
        static_cast<size_t>(layout.island_of[static_cast<size_t>(rasters[k - 1].path)]);
    const size_t island =
        static_cast<size_t>(layout.island_of[static_cast<size_t>(rasters[k].path)]);
    if (island != before) left[before] = true;
    if (left[island]) return false;
  }
  return true;
}

}  // namespace traverse
