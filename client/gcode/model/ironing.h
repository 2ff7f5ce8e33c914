// Finds ironing that the file calls skin.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_IRONING_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_IRONING_H_

#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/outline.h"

namespace traverse::gcode {

// CuraEngine gives ironing the type of the skin that it irons. Skin fills its layer: each of its
// lines deposits as much as the layer is high, times the distance to the next line. Ironing
// deposits a fraction of that, and is told by it alone: path by path, whatever its size, and
// without a look at what lies under it.
//
// Sets the feature of such paths. `outlines` are those of `layer`.
void MarkIroning(const GcodeFile& file, const Layer& layer, std::vector<Outline>& outlines);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_IRONING_H_
