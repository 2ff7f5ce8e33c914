// One layer before and after, side by side on one scale: the picture of --picture.

#ifndef TRAVERSE_CLIENT_VIEW_DRAWING_PICTURE_H_
#define TRAVERSE_CLIENT_VIEW_DRAWING_PICTURE_H_

#include <cstddef>
#include <optional>
#include <string>

#include "client/view/scene/scene.h"

namespace traverse::view {

enum class PictureFormat { kSvg, kPng };

// By the end of the name, .svg or .png in any case; unset for others.
std::optional<PictureFormat> PictureFormatOf(const std::string& name);

// Layer `layer` of the scene in the given order and in that of the shown route: deposited paths
// thin and in the color of their feature, travel bold, start and end marked; on the right, faded,
// the moves that are gone. The figures of both stand above.
std::string Picture(const Scene& scene, size_t layer, PictureFormat format);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_DRAWING_PICTURE_H_
