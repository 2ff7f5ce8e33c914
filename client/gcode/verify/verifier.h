// Does one G-code print exactly what another one prints?
//
// Both are run on a machine of the verifier's own and cut into sections: a section ends at every
// line whose place matters (marks of layers and objects, tool changes, temperatures, modes,
// whatever is not known), and where what is printed changes its height. Equal are
// - the lines that end sections, in their order; where the head is and whether filament is pulled
//   back at lines that are not known; the fan at all of them;
// - in each section, the extruded segments as a multiset: both ends, arc, filament, feed rate,
//   feature, width, height, acceleration, jerk, fan, flow, tool, and whether filament was pulled
//   back; and the comments and M73 lines as a multiset.
// The order within a section, the direction of a segment, and all that deposits nothing may differ,
// but: no travel is lower than the section's lowest in the original, and each prime pushes as much
// more than was pulled back as some prime of the original does.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_VERIFIER_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_VERIFIER_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace traverse {

// A comment that begins with this may be added to, or be missing from, either text.
inline constexpr std::string_view kOptimisedMark = "; optimised by Traverse";

// OK if `optimised` prints what `original` prints. FailedPrecondition otherwise, with the first
// difference and the lines on both sides: `b.gcode:118: extrudes 0.40000 mm to X20 Y10, which
// a.gcode:97 and its section do not`. The names are for messages. Uses two threads. Time linear in
// the texts, memory some bytes for each section; more for the one section that differs.
absl::Status VerifyGcode(std::string_view original, const std::string& original_name,
                         std::string_view optimised, const std::string& optimised_name);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_VERIFIER_H_
