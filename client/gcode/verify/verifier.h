// Checks that one G-code prints what another one prints, and that only allowed changes were made.
//
// Runs both on a machine of its own, which shares no code with the reader and the writer whose work
// it checks, and cuts them into sections. A section ends at every line whose position matters
// (marks of layers and objects, tool changes, temperatures, modes, anything unknown), and where the
// height of what is printed changes. First (VerifyRule::kSamePrint),
// - the lines that end sections are equal, in their order; so are where the head is and whether
//   filament is pulled back at lines that are not known, and the fan at all of them;
// - in each section the extruded segments are equal as a multiset: both ends, arc, filament, feed
//   rate, feature, width, height, acceleration, jerk, fan, flow, tool, and whether filament was
//   pulled back; and the comments as a multiset;
// - no travel is lower than the section's lowest in the original.
// Then it finds each path again. The rules of rules/rules.h check the order of the paths, where
// they begin and in which direction, and everything between them. A move that the original has too,
// from the same point to the same point in the same layer, breaks no rule: what a slicer does
// itself is never refused. All of this must hold whether or not a machine executes the lines that
// begin with a slash. If all lines of both files have consecutive numbers and correct checksums,
// line_numbers.h checks those.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_VERIFIER_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_VERIFIER_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "client/gcode/verify/permissions.h"
#include "client/gcode/verify/report.h"
#include "client/gcode/work_limit.h"

namespace traverse {

struct VerifyOptions {
  // What may have changed. Unset: what the line at the head of the optimised file says, or `safe`
  // if there is none.
  std::optional<VerifyPermissions> permissions;

  // Bit (1 << rule) for each rule to check; kSamePrint is always checked.
  uint32_t rules = UINT32_MAX;

  // When it ends the check is given up: the report then says that it is no proof.
  gcode::WorkLimit limit = {};
};

// All breaks of the rules, with both lines of each: `b.gcode:118: WHAT (lifts; a.gcode:97)`. The
// names are for messages. Uses two threads. Time is linear in the texts; memory holds some
// megabytes of each, and some bytes per section and per travel between paths.
VerifyReport CheckGcode(std::string_view original, const std::string& original_name,
                        std::string_view optimised, const std::string& optimised_name,
                        const VerifyOptions& options = {});

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_VERIFIER_H_
