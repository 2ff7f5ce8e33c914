// Step 4 of the framework: the rules for the route of the rasters.
//
// The route starts at First, the last contour point visited. It visits the rasters of an island one
// after another, in any order and direction, before it goes on to another island.
//
// Source: thesis 3.2, step 4 (p. 67), 4.1.3 (p. 77); SPEC 3.5.

#ifndef TRAVERSE_ENGINE_WELLER_STEPS_RASTER_ROUTE_H_
#define TRAVERSE_ENGINE_WELLER_STEPS_RASTER_ROUTE_H_

#include <vector>

#include "engine/model/route.h"
#include "engine/weller/steps/island_layout.h"

namespace traverse {

// Rasters that are visited together.
struct RasterGroup {
  int island = 0;            // index into IslandLayout::islands
  std::vector<int> rasters;  // indices into Plan::paths, in the given order
};

// `rasters` (indices into Plan::paths) by island, in the order of their first rasters. O(rasters).
std::vector<RasterGroup> GroupRasters(const IslandLayout& layout, const std::vector<int>& rasters);

// Whether `rasters`, visits of only open paths, has the rasters of each island together.
// O(visits).
bool KeepsIslandsTogether(const IslandLayout& layout, const Route& rasters);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_STEPS_RASTER_ROUTE_H_
