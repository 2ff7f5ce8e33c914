// What travel does behind unknown lines, step by step: it retracts, rises, moves sideways, goes
// down and primes as in the original, wherever it leads to.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// Alike but for where they lead to, and for their acceleration.
bool AreLike(const TraceMove& a, const TraceMove& b) { return AreAlike(a, b) && a.open == b.open; }

// What the link to `path` does behind its last unknown line: each step, or several alike as one,
// with no word of how much filament a wipe pulls.
std::vector<TraceMove> StepsTo(const TraceChunk& chunk, uint32_t path) {
  std::vector<TraceMove> steps;
  for (TraceMove move : chunk.MovesOf(path, chunk.links[path].fixed)) {
    if (move.IsNothing(kLeastMoveMm)) continue;
    if (move.kind == MoveKind::kWipe) move.filament = 0;
    // A travel move may have more bends than before.
    const bool goes_on = !steps.empty() && AreLike(steps.back(), move) &&
                         steps.back().acceleration == move.acceleration;
    if (!move.sideways() || !goes_on) steps.push_back(move);
  }
  return steps;
}

// The head sinks from the height of the layer to where a path begins that rises to that, as scarf
// seams do: that belongs to the path.
void LeaveOutSinking(const TracePath& path, std::vector<TraceMove>& steps) {
  const bool sinks = !steps.empty() && steps.back().kind == MoveKind::kDown &&
                     steps.back().z_to_mm < path.z_mm - kOneHeightMm;
  if (sinks) steps.pop_back();
}

// How much farther the travel behind unknown lines leads than straight to its path. Wipes lead
// where their paths do.
double ExcessTo(const TraceChunk& chunk, uint32_t path, double& straight_mm) {
  double length = 0;
  const TraceMove* first = nullptr;
  for (const TraceMove& move : chunk.MovesOf(path, chunk.links[path].fixed)) {
    if (!move.sideways() || move.kind == MoveKind::kWipe) continue;
    if (first == nullptr) first = &move;
    length += move.length_mm();
  }
  straight_mm = first == nullptr ? 0 : Distance(first->from, chunk.paths[path].start);
  return length - straight_mm;
}

// No farther than twice as far as straight, and as much as it winds there.
bool Winds(const LayerPair& layer, uint32_t path_was, uint32_t path_is) {
  double straight = 0;
  const double had = ExcessTo(layer.was(), path_was, straight);
  const double has = ExcessTo(layer.is(), path_is, straight);
  return has > had + straight + kLooseMm;
}

bool IsTravel(const TraceMove& step) { return step.kind == MoveKind::kTravel; }

bool Goes(const std::vector<TraceMove>& steps) { return std::ranges::any_of(steps, IsTravel); }

// Where filament moves alone, its acceleration is that of the path or of the travel.
bool AreAlikeBehindScripts(const TraceMove& a, const TraceMove& b) {
  const bool still = a.kind == MoveKind::kPriming || a.kind == MoveKind::kRetraction;
  return AreLike(a, b) && (still || a.acceleration == b.acceleration);
}

// The paths of the original that begin behind unknown lines, and those of the optimised file in
// their places. Such lines stay where they are, also between objects that have changed places.
std::vector<std::pair<uint32_t, uint32_t>> PathsBehindScripts(const LayerPair& layer) {
  std::vector<uint32_t> were;
  std::vector<uint32_t> are;
  std::vector<std::pair<uint32_t, uint32_t>> of_sections;
  for (size_t i = 0; i < layer.section_count(); ++i) {
    const uint32_t was = layer.SectionWas(i).first_path;
    const uint32_t is = layer.SectionIs(i).first_path;
    if (layer.was().links[was].scripted) {
      were.push_back(was);
      of_sections.emplace_back(was, is);
    }
    if (layer.is().links[is].scripted) are.push_back(is);
  }
  if (were.size() != are.size()) return of_sections;
  std::ranges::sort(were);
  std::ranges::sort(are);
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  for (size_t i = 0; i < were.size(); ++i) pairs.emplace_back(were[i], are[i]);
  return pairs;
}

}  // namespace

void CheckScriptedTravels(const LayerPair& layer, LayerFindings& findings) {
  for (const auto& [was, is] : PathsBehindScripts(layer)) {
    if (layer.Ended()) return;
    const uint32_t before = layer.was().LineOf(was);
    const uint32_t behind = layer.is().LineOf(is);
    if (Winds(layer, was, is)) {
      findings.breaks.push_back({VerifyRule::kBounds, before, behind,
                                 "the travel behind unknown lines winds to this path"});
    }
    std::vector<TraceMove> had = StepsTo(layer.was(), was);
    std::vector<TraceMove> has = StepsTo(layer.is(), is);
    LeaveOutSinking(layer.was().paths[was], had);
    LeaveOutSinking(layer.is().paths[is], has);
    // To a path that begins where the head is, no way leads.
    if (!Goes(had) || !Goes(has)) {
      std::erase_if(had, IsTravel);
      std::erase_if(has, IsTravel);
    }
    const auto [one, other] = std::ranges::mismatch(had, has, AreAlikeBehindScripts);
    if (one == had.end() && other == has.end()) continue;
    findings.breaks.push_back(
        {VerifyRule::kScripts, one == had.end() ? before : one->line,
         other == has.end() ? behind : other->line,
         absl::StrFormat("a %s behind unknown lines; the original has another %s there",
                         other == has.end() ? "path" : MoveKindName(other->kind),
                         one == had.end() ? "path" : MoveKindName(one->kind))});
  }
}

}  // namespace traverse::gcode
