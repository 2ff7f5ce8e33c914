// `Metadata/slice_info.config` of a .gcode.3mf: what Bambu Studio and OrcaSlicer say of each plate.
//
//   <plate>
//     <metadata key="index" value="1"/>
//     <metadata key="prediction" value="543"/>   seconds
//
// Changed in place, not parsed and rewritten: a printer's parser may differ from ours.

#ifndef TRAVERSE_CLIENT_CONTAINERS_ZIP_SLICE_INFO_H_
#define TRAVERSE_CLIENT_CONTAINERS_ZIP_SLICE_INFO_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "client/gcode/stated_times.h"

namespace traverse::containers {

// The value of `key` for plate `plate`; empty if there is none.
std::string PlateValue(std::string_view slice_info, uint32_t plate, std::string_view key);

// `slice_info` with the times of plate `plate` scaled: `prediction`, `first_layer_time`.
std::string RestatePlate(std::string slice_info, uint32_t plate, const gcode::TimeScale& scale);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_ZIP_SLICE_INFO_H_
