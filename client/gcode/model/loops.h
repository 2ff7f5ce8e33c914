// Finds the loops that are visible walls, in files that do not name features.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_LOOPS_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_LOOPS_H_

#include <vector>

#include "client/gcode/model/outline.h"

namespace traverse::gcode {

// The outlines of a layer. Distinguishes CuraEngine's ironing from the skin that it irons. A loop
// without a name (Feature::kLoop) becomes an inner wall if another loop lies along most of its
// outer side (two paths that make up a loop count as one, for example where one was started
// elsewhere). Slicers print outlines counter-clockwise and holes clockwise, so the outside is
// always on the right.
std::vector<Outline> OutlinesOf(const GcodeFile& file, const Layer& layer);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_LOOPS_H_
