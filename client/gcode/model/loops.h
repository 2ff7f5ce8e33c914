// Which loops are visible walls, in files that do not name features.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_LOOPS_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_LOOPS_H_

#include <vector>

#include "client/gcode/model/outline.h"

namespace traverse::gcode {

// The outlines of a layer. CuraEngine's ironing is told from the skin that it irons. Of loops
// without a name (Feature::kLoop) those become inner walls that have another loop along most of
// their outer side (two paths that make up a loop, as where one was begun elsewhere, count as one):
// slicers print outlines counter-clockwise and holes clockwise, so that the outside is always on
// the right.
std::vector<Outline> OutlinesOf(const GcodeFile& file, const Layer& layer);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_LOOPS_H_
