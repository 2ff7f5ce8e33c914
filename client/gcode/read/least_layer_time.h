// The least time of a layer that a slicer was asked for, so that what is printed cools.

#ifndef TRAVERSE_CLIENT_GCODE_READ_LEAST_LAYER_TIME_H_
#define TRAVERSE_CLIENT_GCODE_READ_LEAST_LAYER_TIME_H_

#include <string_view>

namespace traverse::gcode {

// Where a file states none.
inline constexpr double kUsualLeastLayerSeconds = 10;

// The greatest least time of a layer that the settings in `text` state, in seconds: of any tool and
// filament, in the words of any slicer, such as
//
//   ; slowdown_below_layer_time = 5,8         PrusaSlicer
//   ;   minSpeedLayerTime,15                  Simplify3D
//   ;SETTING_3 ...\\ncool_min_layer_time = 6  CuraEngine, whose lines may end amid a word
//
// kUsualLeastLayerSeconds if they state none.
double LeastLayerSeconds(std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_READ_LEAST_LAYER_TIME_H_
