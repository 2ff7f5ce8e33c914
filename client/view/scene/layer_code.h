// Encodes layers in few bytes, for the report; web/src/scene.js reads them.

#ifndef TRAVERSE_CLIENT_VIEW_SCENE_LAYER_CODE_H_
#define TRAVERSE_CLIENT_VIEW_SCENE_LAYER_CODE_H_

#include <string>
#include <string_view>

#include "client/view/scene/scene.h"

namespace traverse::view {

// Positions are whole multiples of this.
inline constexpr double kGridMm = 0.02;

// The layer as a sequence of numbers. A number is written in groups of seven bits, the lowest
// first, all but the last with the eighth bit set; a signed one as 2n, or -2n - 1 if negative.
// Positions are differences, in steps of the grid, to the one before. From its third point on, a
// path has differences to where it would come if it went straight on, because curves are smooth.
//
//   paths: how many; each: 2 * feature + closed, how many points, the points
//   routes, as many as the scene has; each: the start (difference to 0, 0), and for each visit
//     the path (difference to the one behind the path before), 8 * entry + 2 * form + has corners,
//     and if it has corners: how many, the corners (the first as a difference to the exit before)
std::string LayerCode(const DrawnLayer& layer);

// `bytes` in zlib format, and that in base64.
std::string DeflatedBase64(std::string_view bytes);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_SCENE_LAYER_CODE_H_
