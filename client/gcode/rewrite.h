// From a sliced file and an order of paths for each layer to equivalent G-code with less travel.

#ifndef TRAVERSE_CLIENT_GCODE_REWRITE_H_
#define TRAVERSE_CLIENT_GCODE_REWRITE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/gcode/choose/layer_choice.h"
#include "client/gcode/measure/print_totals.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/plan/policy.h"

namespace traverse {

struct GcodeRewrite {
  std::string text;  // of the new file; that of the old one if nothing was gained
  gcode::PrintTotals before;
  gcode::PrintTotals after;
  gcode::PrintTotals first_before;  // of the first layer alone
  gcode::PrintTotals first_after;
  gcode::FileOrder orders;  // [layer] as in `text`; empty for that of the old file
  int64_t layers = 0;
  int64_t layers_changed = 0;

  // Layers that were left as they are because what was found for them breaks a rule of the
  // verifier, and the first break that was found.
  int64_t layers_unproven = 0;
  std::string unproven;

  // Layers that were left as they are for a line of which nobody knows what a machine makes of it,
  // and the first of these: "part.gcode:118: G2 without I, J or R".
  int64_t layers_unclear = 0;
  std::string unclear;
};

struct RewriteOptions {
  gcode::Policy policy = gcode::Policy::kSafe;
  gcode::Crossings crossings = gcode::Crossings::kKeep;
  gcode::Allowance allow = {};     // is in that line too
  double min_revisit_seconds = 0;  // no island is printed on sooner than it was, unless so late
  std::string version;             // of this program, for the line that is added behind the head
  int threads = 1;
};

// Writes `file` with each layer in one of the orders that `tries` have for it, or in its own,
// whichever makes the quickest print by the estimate; under Policy::kSafe no layer's travel grows,
// neither within the layer nor with the way to it, and walls are spared (layer_choice.h). The text
// is verified by all rules of `policy` before it is returned (verify/verifier.h), and `after` is
// measured on it. What breaks a rule is ruled out, layer by layer, and the file is written again.
//
// Each order is empty, or of paths of its layer. One that has a path twice, or that a plan of
// `policy` does not allow, is found when the text is verified: its layer stays as it is.
// An error if the new text cannot be read again: a fault of ours.
absl::StatusOr<GcodeRewrite> RewriteGcode(const GcodeFile& file,
                                          const std::vector<gcode::FileOrder>& tries,
                                          const RewriteOptions& options);

// "travel 15.27 -> 12.41 m (-18.7 %), retractions 1187 -> 1059, estimated print time ..."
std::string DescribeRewrite(const GcodeRewrite& rewrite);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_REWRITE_H_
