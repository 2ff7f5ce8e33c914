// What the links of a file are to its paths.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_PART_LINKS_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_PART_LINKS_H_

#include <cstdint>

#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

// Whether nothing crosses the link before `block`: it has marks, or stays byte by byte.
inline bool IsBoundary(const Block& block) {
  return (block.link & (kLinkSplits | kLinkFixed)) != 0;
}

// Whether the link to `block` leads from one path of the part itself to another: neither is printed
// by a script or on a tower.
bool LeadsWithinPart(const GcodeFile& file, uint32_t block);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_PART_LINKS_H_
