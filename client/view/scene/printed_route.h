// The ways that the head takes in G-code.

#ifndef TRAVERSE_CLIENT_VIEW_SCENE_PRINTED_ROUTE_H_
#define TRAVERSE_CLIENT_VIEW_SCENE_PRINTED_ROUTE_H_

#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/view/scene/scene.h"

namespace traverse::view {

// A layer's paths, as they are in the file that was optimised.
struct SlicedPaths {
  const std::vector<DrawnPath>& paths;
  std::vector<double> lengths_mm;  // [path] of what is extruded
};

// Each path of a layer in its own order, begun where it is given.
std::vector<DrawnVisit> InOrder(size_t paths);

// The route through layer `layer` of `printed`, with the corners of its travel. `orders` are the
// orders in which `printed` may have the paths; the first that fits is taken. Read again, a path
// may be two blocks (a loop from another start, across the gap between its ends), and two paths
// without a move between them one. Where no order fits, that is the first one with straight moves.
// REQUIRES: at least one order.
DrawnRoute PrintedRoute(const GcodeFile& printed, size_t layer, const SlicedPaths& sliced,
                        const std::vector<std::vector<DrawnVisit>>& orders);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_SCENE_PRINTED_ROUTE_H_
