// Where a loop may begin.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_LOOP_STARTS_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_LOOP_STARTS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "engine/model/point.h"

namespace traverse::gcode {

// A search looks at pairs of starts: so many of each loop cost it little, and more of them save
// next to nothing.
inline constexpr size_t kMostStarts = 256;

// The vertices at corners about as sharp as the sharpest, and the given start, 0. `loop` has each
// vertex once. Ascending.
std::vector<uint32_t> SharpCorners(absl::Span<const Point> loop);

// About kMostStarts of `starts`, evenly along the loop, with the first one: a start that is left
// out has one that stays within a share 1 / kMostStarts of the loop's length. `starts` are
// ascending vertices of `loop`, or all of them if empty, and come back as they are if they are no
// more than that. REQUIRES: `loop` is not empty.
std::vector<uint32_t> ThinnedStarts(absl::Span<const Point> loop, std::vector<uint32_t> starts);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_LOOP_STARTS_H_
