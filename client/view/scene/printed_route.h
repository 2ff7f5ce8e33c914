// The actual moves of the head in G-code.

#ifndef TRAVERSE_CLIENT_VIEW_SCENE_PRINTED_ROUTE_H_
#define TRAVERSE_CLIENT_VIEW_SCENE_PRINTED_ROUTE_H_

#include <vector>

#include "client/gcode/link/link_looks.h"
#include "client/gcode/model/gcode_file.h"
#include "client/view/scene/scene.h"

namespace traverse::view {

// A layer's paths, as they are in the original file.
struct SlicedPaths {
  const std::vector<DrawnPath>& paths;
  std::vector<double> lengths_mm;  // [path] extruded length
};

// Each path of a layer in its own order, entered where it is given.
std::vector<DrawnVisit> InOrder(size_t paths);

// The route through layer `layer` of `printed`, which has the paths in `order`, with the corners
// and the forms of its travel; `looks` are those of its blocks. When read again, a path may be two
// blocks (a loop from another start, across the gap between its ends), and two paths without a move
// between them one. If the blocks do not fit the order, its moves are straight.
DrawnRoute PrintedRoute(const GcodeFile& printed, size_t layer, const SlicedPaths& sliced,
                        const std::vector<DrawnVisit>& order,
                        const std::vector<gcode::LinkLook>& looks);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_SCENE_PRINTED_ROUTE_H_
