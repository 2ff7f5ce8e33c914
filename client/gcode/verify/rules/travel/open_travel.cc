// A layer has no more unretracted travel across outer walls, or right over them, than before, and
// none longer than the longest before. The travel to a layer belongs to it.

#include <algorithm>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

struct OpenTravel {
  double length_mm = 0;
  uint32_t line = 0;
  bool known = true;
};

std::vector<OpenTravel> OpenTravels(const LayerPair& layer, bool original) {
  const LayerSide& side = layer.Side(original);
  std::vector<OpenTravel> travels;
  for (uint32_t link = side.first_path; link < side.end_path && !layer.Ended(); ++link) {
    const absl::Span<const TraceMove> moves = side.chunk.MovesOf(link);
    if (moves.empty()) continue;
    // Travel begins where the move along the path before it ends.
    const double length = layer.OpenLengthOverWalls(side.chunk, link, side.AlongOf(link));
    if (length <= 0) continue;
    OpenTravel travel{length, moves.front().line, true};
    for (const TraceMove& move : moves) {
      if (move.kind != MoveKind::kTravel || !move.open || layer.IsKnown(move)) continue;
      if (travel.known) travel.line = move.line;
      travel.known = false;
    }
    travels.push_back(travel);
  }
  return travels;
}

}  // namespace

void CheckOpenTravels(const LayerPair& layer, LayerFindings& findings) {
  if (layer.outer_walls().empty()) return;
  const std::vector<OpenTravel> is = OpenTravels(layer, false);
  if (std::ranges::all_of(is, [](const OpenTravel& travel) { return travel.known; })) return;
  const std::vector<OpenTravel> was = OpenTravels(layer, true);
  const auto longest = std::ranges::max_element(
      was, [](const OpenTravel& a, const OpenTravel& b) { return a.length_mm < b.length_mm; });
  const uint32_t of_layer = layer.was().LineOf(layer.first_path_was());
  size_t more = is.size() > was.size() ? is.size() - was.size() : 0;
  for (const OpenTravel& travel : is) {
    if (travel.known) continue;
    if (longest != was.end() && travel.length_mm > longest->length_mm + kSamePointMm) {
      findings.breaks.push_back(
          {VerifyRule::kOpenTravels, longest->line, travel.line,
           absl::StrFormat("travel of %.2f mm crosses an outer wall without a retraction; the "
                           "longest such travel of the layer has %.2f mm",
                           travel.length_mm, longest->length_mm)});
    } else if (more > 0) {
      --more;
      findings.breaks.push_back({VerifyRule::kOpenTravels, of_layer, travel.line,
                                 absl::StrFormat("travel crosses an outer wall without a "
                                                 "retraction, one of %d in a layer that had %d",
                                                 is.size(), was.size())});
    }
  }
}

}  // namespace traverse::gcode
