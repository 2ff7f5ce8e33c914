// Does one G-code print what another one prints, with nothing changed that is not allowed?
//
// Both are run on a machine of the verifier's own, which shares no code with the reader and the
// writer whose work it checks, and cut into sections: a section ends at every line whose place
// matters (marks of layers and objects, tool changes, temperatures, modes, whatever is not known),
// and where what is printed changes its height. First (VerifyRule::kSamePrint),
// - the lines that end sections are equal, in their order; so are where the head is and whether
//   filament is pulled back at lines that are not known, and the fan at all of them;
// - in each section the extruded segments are equal as a multiset: both ends, arc, filament, feed
//   rate, feature, width, height, acceleration, jerk, fan, flow, tool, and whether filament was
//   pulled back; and the comments and M73 lines as a multiset;
// - no travel is lower than the section's lowest in the original.
// Then each path is found again, and the rules of rules/rules.h look at the order of the paths, at
// where they begin and in which direction, and at all that is done between them. A move that the
// original has too, from the same point to the same point in the same layer, breaks no rule: what a
// slicer does itself is never refused. All of it holds whether or not a machine does the lines that
// begin with a slash. Where all lines of both files are numbered on and their checksums are right,
// that is what is looked at of these (line_numbers.h).

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_VERIFIER_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_VERIFIER_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "client/gcode/verify/permissions.h"
#include "client/gcode/verify/report.h"

namespace traverse {

struct VerifyOptions {
  // What may have been changed. Unset: what the line at the head of the optimised file says, or
  // `safe` if there is none.
  std::optional<VerifyPermissions> permissions;

  // Bit (1 << rule) for each rule to check; kSamePrint always is.
  uint32_t rules = UINT32_MAX;
};

// Options to check no more than that the same is printed.
inline VerifyOptions OnlySamePrint() {
  VerifyOptions options;
  options.rules = RuleBit(VerifyRule::kSamePrint);
  return options;
}

// All breaks of the rules, with both lines of each: `b.gcode:118: WHAT (lifts; a.gcode:97)`. The
// names are for messages. Uses two threads. Time linear in the texts; memory for some megabytes of
// each, and some bytes for each section and each way between paths.
VerifyReport CheckGcode(std::string_view original, const std::string& original_name,
                        std::string_view optimised, const std::string& optimised_name,
                        const VerifyOptions& options = {});

// OK if there is no break; FailedPrecondition with the first one otherwise.
absl::Status VerifyGcode(std::string_view original, const std::string& original_name,
                         std::string_view optimised, const std::string& optimised_name,
                         const VerifyOptions& options = {});

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_VERIFIER_H_
