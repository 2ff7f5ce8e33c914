// New travel is straight, except for bends that lead around an outer wall: without such a bend it
// would cross one, and with it does not. So no travel overshoots its end or leads out of the
// print, and none is led along a wall. None goes along an arc of its own. Hidden travel may bend
// where that hides it (hidden_links.h).

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/match/turned_departures.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// Moves along a path to another layer may be as long, whatever the original's.
constexpr double kAlongToLayerMm = 1.0;

// How far the travel lies off the straight move that the two might be.
double BendOf(const TraceMove& before, const TraceMove& behind) {
  return DistanceToPiece(before.to, before.from, behind.to);
}

// How much longer the travel is because of the bend between the two.
double ExcessOf(const TraceMove& before, const TraceMove& behind) {
  return before.length_mm() + behind.length_mm() - Distance(before.from, behind.to);
}

bool LeadsAroundAWall(const LayerPair& layer, const TraceMove& before, const TraceMove& behind) {
  return layer.CrossesOuterWall(before.from, behind.to) &&
         !layer.CrossesOuterWall(before.from, before.to) &&
         !layer.CrossesOuterWall(behind.from, behind.to);
}

// The head sinks between the two, to a path that lies lower than the one before: where it may do so
// is said elsewhere (travel_heights.cc).
bool SinksBetween(const TraceChunk& is, uint32_t link, const TraceMove& before,
                  const TraceMove& behind) {
  const double printed = is.MovesOf(link).front().z_from_mm;
  return is.paths[link].z_mm < printed - kOneHeightMm &&
         behind.z_from_mm < before.z_to_mm - kOneHeightMm;
}

// The short moves by which travel of the original leaves the paths of some layers, by where they
// lead from and to: those of new travel are among them.
absl::flat_hash_set<uint64_t> DeparturesOf(const TraceChunk& was, uint32_t first_link,
                                           uint32_t end_link) {
  absl::flat_hash_set<uint64_t> ends;
  for (uint32_t link = first_link; link < end_link; ++link) {
    double length = 0;
    for (const TraceMove& move : was.MovesOf(link)) {
      if (move.sideways()) length += move.length_mm();
      if (length > kLongestDepartureMm) break;
      if (move.sideways()) ends.insert(DigestOfEnds(move.from, move.to));
    }
  }
  return ends;
}

// Of the layer and, as travel to it leaves a path of another one, of the layer before.
std::optional<absl::flat_hash_set<uint64_t>> DeparturesTo(const LayerPair& layer) {
  const std::vector<TraceLayer>& layers = layer.was().layers;
  const size_t own = layer.place();
  // What is before a chunk is not there any more.
  if (own == 0 && layer.index() > 0) return std::nullopt;
  const TraceLayer& first = layers[own == 0 ? 0 : own - 1];
  uint32_t first_path = layer.first_path_was();
  for (uint32_t s = first.first_section; s < first.end_section; ++s) {
    first_path = std::min(first_path, layer.was().sections[s].first_path);
  }
  return DeparturesOf(layer.was(), first_path, layer.first_path_was() + 1);
}

void CheckLink(const LayerPair& layer, uint32_t link, uint32_t skipped,
               const std::optional<absl::flat_hash_set<uint64_t>>& departures,
               LayerFindings& findings) {
  const TraceChunk& is = layer.is();
  const TraceMove* before = nullptr;
  // Up to an unknown line nothing changes: scripts.
  for (const TraceMove& move : is.MovesOf(link, std::max(skipped, is.links[link].fixed))) {
    if (!move.sideways()) continue;
    if (move.kind == MoveKind::kTravel && move.in_print && move.arc && !layer.IsKnown(move)) {
      findings.breaks.push_back(
          {VerifyRule::kBounds, layer.OriginalLine(link), move.line,
           "travel along an arc that the original does not have in this layer"});
    }
    const bool counts = move.kind == MoveKind::kTravel && move.in_print && !move.arc;
    const TraceMove* last = std::exchange(before, counts ? &move : nullptr);
    if (last == nullptr || before == nullptr) continue;
    if (layer.IsKnown(*last) || layer.IsKnown(move)) continue;
    const bool departs = departures ? departures->contains(DigestOfEnds(last->from, last->to))
                                    : last->length_mm() <= kLongestDepartureMm;
    if (departs) continue;
    if (SinksBetween(is, link, *last, move)) continue;
    const double bend = BendOf(*last, move);
    if (bend <= kSamePointMm) continue;
    if (LeadsAroundAWall(layer, *last, move)) {
      findings.is.detours.push_back(
          {{last->line, layer.index()}, static_cast<float>(ExcessOf(*last, move))});
      continue;
    }
    findings.breaks.push_back(
        {VerifyRule::kBounds, layer.OriginalLine(link), last->line,
         absl::StrFormat("travel bends by %.2f mm, but leads around no outer wall", bend)});
  }
}

// Travel of the original's layer that bends around an outer wall: one is enough.
void ObserveDetour(const LayerPair& layer, Observations& seen) {
  const absl::Span<const TraceMove> moves =
      layer.was().MovesOfLinks(layer.first_path_was(), layer.end_path_was());
  for (size_t m = 1; m < moves.size(); ++m) {
    const TraceMove& before = moves[m - 1];
    const TraceMove& move = moves[m];
    if (!before.sideways() || !move.sideways() || !before.in_print) continue;
    const bool bends = BendOf(before, move) > kSamePointMm;
    if (!bends || !LeadsAroundAWall(layer, before, move)) continue;
    seen.detours.push_back(
        {{before.line, layer.index()}, static_cast<float>(ExcessOf(before, move))});
    return;
  }
}

// Of what goes along paths of the original, however fast.
double LongestAlong(const LayerPair& layer) {
  double longest = 0;
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    double length = 0;
    for (const TraceMove& move : layer.Side(true).MovesAlong(link)) {
      length += move.length_mm();
    }
    longest = std::max(longest, length);
  }
  return longest;
}

}  // namespace

void CompareBounds(const Observations& was, const Observations& is, const RuleContext& context,
                   std::vector<Finding>& breaks) {
  for (const Detour& detour : is.detours) {
    if (!was.detours.empty() || context.settings.leads_around_walls) break;
    breaks.push_back({VerifyRule::kBounds, 0, detour.at,
                      absl::StrFormat("travel is %.2f mm longer because of a bend around an outer "
                                      "wall; the original leads no travel around walls",
                                      detour.excess_mm)});
  }
}

void CheckBends(const LayerPair& layer, LayerFindings& findings) {
  ObserveDetour(layer, findings.was);
  const LayerSide& side = layer.Side(false);
  // Moves along a path may be as fast as travel, if no longer than such in the original.
  const double longest = LongestAlong(layer);
  const absl::flat_hash_set<uint32_t> turned = TurnedDepartures(layer);
  const auto to_layer = DeparturesTo(layer);
  const std::optional within =
      DeparturesOf(layer.was(), layer.first_path_was(), layer.end_path_was() + 1);
  for (uint32_t link = layer.first_path_is(); link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    if (layer.IsHidden(link)) continue;
    // The travel to the layer leaves a path of another one.
    const bool first = link == layer.first_path_is();
    const double most = first ? std::max(longest, kAlongToLayerMm) : longest;
    const uint32_t moves = MovesWithin(side.MovesAlong(link), most + kOnPathMm);
    // How travel leaves a loop is another rule (leaving_paths.cc), there of the layer before.
    const bool departs = first ? DepartureOf(layer.is(), link) != nullptr : turned.contains(link);
    const uint32_t skipped = std::max({side.TailOf(link), moves, departs ? 1u : 0u});
    CheckLink(layer, link, skipped, first ? to_layer : within, findings);
  }
}

}  // namespace traverse::gcode
