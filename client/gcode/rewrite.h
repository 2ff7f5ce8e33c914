// From a sliced file and an order of paths for each layer to equivalent G-code with less travel.

#ifndef TRAVERSE_CLIENT_GCODE_REWRITE_H_
#define TRAVERSE_CLIENT_GCODE_REWRITE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/gcode/choose/chosen_layers.h"
#include "client/gcode/measure/print_totals.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/plan/policy.h"

namespace traverse {

struct GcodeRewrite {
  std::string text;  // of the new file; that of the old one if nothing was gained
  gcode::PrintTotals before;
  gcode::PrintTotals after;
  gcode::Forecast forecast;         // of the orders of `text`, as the search counts
  gcode::RestTotals rest;           // of islands before they are printed on
  double fast_seconds = 0;          // what Policy::kFast would save, if that was asked for: about
  gcode::PrintTotals first_before;  // of the first layer only
  gcode::PrintTotals first_after;
  gcode::FileOrder orders;  // [layer] as in `text`; empty for that of the old file
  int64_t layers = 0;
  int64_t layers_changed = 0;

  // Layers left unchanged because every order found for them breaks a rule of the verifier, and
  // what the first break is of, in words that go on behind "it could not be proven that".
  int64_t layers_unproven = 0;
  std::string unproven;

  // Layers left unchanged because of a line that machines interpret differently, and the first of
  // these lines: "part.gcode:118: G2 without I, J or R".
  int64_t layers_unclear = 0;
  std::string unclear;

  // Layers for which orders were found whose travel leads into what stands higher, and the first of
  // these: "part.gcode:118". What they have now leads past it, or stays.
  int64_t layers_blocked = 0;
  std::string blocked;

  // If some layers are left as sliced: what keeps their paths in their places (barriers.h), and
  // which statements of progress cannot be true (stated_progress.h).
  std::vector<std::string> barriers;

  // Lines of moves that no path is made of (barriers.h).
  std::vector<std::string> odd_lines;
};

struct RewriteOptions : gcode::ChoiceOptions {
  // Of this program, for the line that it adds after the head, where what may change is too.
  std::string version;

  // Tell what Policy::kFast would save, unless `policy` is that.
  bool forecast_fast = false;
};

// Writes `file` with each layer in an order made of the one in `found`, or in its own, whichever
// makes the fastest print by the estimate and spares walls (layer_choice.h). Verifies the text by
// all rules of `policy` before returning it (verify/verifier.h), and measures `after` on it. What
// breaks a rule is ruled out, layer by layer, and the file is written again.
//
// `found` is empty, or has an order for each layer: empty, or of paths of its layer. If one has a
// path twice, or a plan of `policy` does not allow it, the verifier finds that and the layer stays
// unchanged. Cancelled or DeadlineExceeded once file.limit ends. Another error if the new text
// cannot be read again: that is our bug.
absl::StatusOr<GcodeRewrite> RewriteGcode(const GcodeFile& file, const gcode::FileOrder& found,
                                          const RewriteOptions& options);

// "travel 15.27 -> 12.41 m (-18.7 %), retractions 1187 -> 1059, estimated print time ..."
std::string DescribeRewrite(const GcodeRewrite& rewrite);

// "least rest of an island 14.6 -> 14.2 s (10 s are enough)"; empty if none rests.
std::string DescribeRest(const GcodeRewrite& rewrite);

// "`--policy=fast` would save about 12 % of the print time (14:10)"; empty if that is not known, or
// not more than what is saved by half a percent.
std::string DescribeFast(const GcodeRewrite& rewrite);

// What stays as it was and why, a line for each reason, with the place of the first: "2 layers left
// unchanged, because ...: part.gcode:118: ..."; and what keeps paths from changing places.
std::vector<std::string> DescribeLeft(const GcodeRewrite& rewrite);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_REWRITE_H_
