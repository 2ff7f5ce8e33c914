// The heights of travel, whether or not travel of its kind is lifted. None is lower than the higher
// of the two paths that it connects, unless such travel of the original is, and none descends over
// a longer stretch. How high lifts are, and in which order the head takes them, parts of travel
// tell (made_of_parts.cc); where it descends to what is lower, what stands there (obstacles.cc).

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

TravelRise RiseOf(double from, double to) {
  if (std::abs(to - from) <= kOneHeightMm) return TravelRise::kLevel;
  return to > from ? TravelRise::kUp : TravelRise::kDown;
}

// Travel from the start script is no example for other travel: it is only no higher, and no lower,
// than it was.
void ObserveFirstTravel(const LayerPair& layer, absl::Span<const TraceMove> moves,
                        Observations& seen) {
  for (const TraceMove& move : moves) {
    if (!move.in_print) continue;
    const ExtremePoint point{move.z_to_mm, {move.line, layer.index()}};
    ExtremePoint& highest = seen.first_highest;
    if (highest.at.line == 0 || point.z_mm > highest.z_mm) highest = point;
    ExtremePoint& lowest = seen.first_lowest;
    if (lowest.at.line == 0 || point.z_mm < lowest.z_mm) lowest = point;
  }
}

// How the head goes up and down on the travel of one link.
void Observe(const LayerPair& layer, const LayerSide& side, uint32_t link, Observations& seen) {
  const absl::Span<const TraceMove> moves = side.chunk.MovesOf(link);
  if (moves.empty()) return;
  if (!moves.front().in_print) return ObserveFirstTravel(layer, moves, seen);
  const double from = moves.front().z_from_mm;
  const double to = side.chunk.paths[link].z_mm;
  TravelExtreme lowest{0, {0, layer.index()}, RiseOf(from, to)};
  TravelExtreme descent = lowest;
  // A new departure, or tail to another height, is as high as the path before; those of the
  // original are examples.
  const TraceMove* departure = side.original ? nullptr : DepartureOf(side.chunk, link);
  const bool skips_tail = !side.original && lowest.rise != TravelRise::kLevel;
  const uint32_t tail = skips_tail ? side.TailOf(link) : 0;
  for (const TraceMove& move : moves.subspan(tail)) {
    if (!layer.Counts(side, move) || &move == departure) continue;
    if (move.kind != MoveKind::kTravel || move.length_mm() < kLeastMoveMm) continue;
    const auto length = static_cast<float>(move.length_mm());
    if (move.z_to_mm < move.z_from_mm - kHeightSlackMm && length > descent.mm) {
      descent.mm = length;
      descent.at.line = move.line;
    }
    const auto above = static_cast<float>(move.z_to_mm - std::max(from, to));
    if (above >= lowest.mm) continue;
    lowest.mm = above;
    lowest.at.line = move.line;
  }
  if (descent.at.line != 0) seen.descents.push_back(descent);
  if (lowest.at.line != 0) seen.lowest.push_back(lowest);
}

// Of travel that connects heights alike `side` times what it does is at most what the original's
// does.
void CompareExtremes(const std::vector<TravelExtreme>& was, const std::vector<TravelExtreme>& is,
                     float side, double slack_mm, const absl::FormatSpec<float, float>& what,
                     std::vector<Finding>& breaks) {
  std::array<TravelExtreme, static_cast<size_t>(TravelRise::kCount)> known;
  for (const TravelExtreme& travel : was) {
    TravelExtreme& most = known[static_cast<size_t>(travel.rise)];
    if (side * travel.mm > side * most.mm) most = travel;
  }
  for (const TravelExtreme& travel : is) {
    const TravelExtreme& most = known[static_cast<size_t>(travel.rise)];
    if (side * travel.mm <= side * most.mm + slack_mm) continue;
    breaks.push_back({VerifyRule::kLifts, most.at.line, travel.at,
                      absl::StrFormat(what, side * travel.mm, side * most.mm)});
  }
}

void CompareFirstTravel(const Observations& was, const Observations& is,
                        std::vector<Finding>& breaks) {
  const auto compare = [&breaks](const ExtremePoint& had, const ExtremePoint& has, double side,
                                 const char* leads) {
    if (had.at.line == 0 || has.at.line == 0 || side * (has.z_mm - had.z_mm) <= kHeightSlackMm)
      return;
    breaks.push_back({VerifyRule::kLifts, had.at.line, has.at,
                      absl::StrFormat("travel from the start script %s to Z%.3f; in the original "
                                      "to Z%.3f",
                                      leads, has.z_mm, had.z_mm)});
  };
  compare(was.first_highest, is.first_highest, 1, "rises");
  compare(was.first_lowest, is.first_lowest, -1, "descends");
}

}  // namespace

void ObserveHeights(const LayerPair& layer, LayerFindings& findings) {
  layer.ForEachLink(
      [&](const LayerSide& side, uint32_t link) { Observe(layer, side, link, findings.Of(side)); });
}

void CompareHeights(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  CompareFirstTravel(was, is, breaks);
  CompareExtremes(was.descents, is.descents, 1, kLeastTravelMm,
                  "the head descends over %.2f mm of travel; in the original over %.2f mm at most",
                  breaks);
  CompareExtremes(was.lowest, is.lowest, -1, kHeightSlackMm,
                  "travel is %.3f mm below the paths that it connects; in the original %.3f mm at "
                  "most",
                  breaks);
}

}  // namespace traverse::gcode
