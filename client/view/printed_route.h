// The ways that the head takes in G-code.

#ifndef TRAVERSE_CLIENT_VIEW_PRINTED_ROUTE_H_
#define TRAVERSE_CLIENT_VIEW_PRINTED_ROUTE_H_

#include <vector>

#include "client/gcode/gcode_file.h"
#include "client/view/scene.h"

namespace traverse::view {

// Each path of a layer in its own order, begun where it is given.
std::vector<DrawnVisit> InOrder(size_t paths);

// The route through layer `layer` of `printed`, with the corners of its travel. `paths` are those
// of the same layer in the file that it was made of; `orders` are the orders in which `printed` may
// have them, of which the first that fits is taken. Where none does, for its text reads as other
// paths, that is the first one with straight moves.
// REQUIRES: at least one order.
DrawnRoute PrintedRoute(const GcodeFile& printed, size_t layer, const std::vector<DrawnPath>& paths,
                        const std::vector<std::vector<DrawnVisit>>& orders);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_PRINTED_ROUTE_H_
