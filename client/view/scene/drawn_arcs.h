// Draws G-code paths as they are printed, with round arcs.

#ifndef TRAVERSE_CLIENT_VIEW_SCENE_DRAWN_ARCS_H_
#define TRAVERSE_CLIENT_VIEW_SCENE_DRAWN_ARCS_H_

#include "client/gcode/model/gcode_file.h"
#include "client/view/scene/scene.h"

namespace traverse::view {

// Puts points on the arcs of the layer's paths, which until then are straight between the ends of
// their segments, and shifts the entries of its routes accordingly. The paths are the blocks of
// layer `layer` of `file`, in order.
void DrawArcs(const GcodeFile& file, size_t layer, DrawnLayer& drawn);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_SCENE_DRAWN_ARCS_H_
