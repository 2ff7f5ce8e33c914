// Layers in which whole labelled objects have changed places.
//
//   original    A A | B | C C        sections under the labels of A, B, C; what stands between two
//   optimised   B | C C | A A        objects stays between two
//
// A section of the optimised file is that of the original with as many before it under the same
// labels, so that every deposit is found under its own.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_MOVED_OBJECTS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_MOVED_OBJECTS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/gcode/verify/sections.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

struct MovedLayer {
  size_t first = 0;  // sections [first, end), in both files
  size_t end = 0;
  std::vector<uint32_t> was;  // [section - first of the optimised file] that of the original

  // The same of the line with which a section ends: behind an object it is that behind as many
  // objects, for it may be the label of the next one, or the mark of a layer.
  std::vector<uint32_t> ends;

  // [section - first of the optimised file] its object goes on behind it.
  std::vector<bool> goes_on;

  uint32_t Of(size_t section) const { return was[section - first]; }
};

// The layers among sections [first, end) that have other labels in another order, as far as each
// object is one run in both files, and nothing passes what stands under no label, what is not
// known, or a change of temperature. Others are left out: they differ section by section.
std::vector<MovedLayer> FindMovedLayers(const Sections& was, const Sections& is, size_t first,
                                        size_t end);

// Puts the sections of `was` in the order of those of the other file that they are found in, with
// their numbers.
void OrderAsMoved(const std::vector<MovedLayer>& layers, TraceChunk& was);

// Gives what happens in the sections of `is` the numbers of those of the original.
void NumberAsOriginal(const std::vector<MovedLayer>& layers, TraceChunk& is);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_MOVED_OBJECTS_H_
