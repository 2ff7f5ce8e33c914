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
    const ExtremePoint point{move.z_to_mm, move.line, layer.index()};
    ExtremePoint& highest = seen.first_highest;
    if (highest.line == 0 || point.z_mm > highest.z_mm) highest = point;
    ExtremePoint& lowest = seen.first_lowest;
    if (lowest.line == 0 || point.z_mm < lowest.z_mm) lowest = point;
  }
}

// How the head goes up and down on the travel of one link.
class LinkHeights {
 public:
  LinkHeights(double from, double to, int64_t layer, Observations& seen)
      : from_(from),
        to_(to),
        seen_(seen),
        lowest_{0, 0, layer, RiseOf(from, to)},
        descent_{0, 0, layer, lowest_.rise} {}

  void NoteDepth(const TraceMove& move) {
    if (move.kind != MoveKind::kTravel || move.length_mm() < kLeastMoveMm) return;
    const auto length = static_cast<float>(move.length_mm());
    if (move.z_to_mm < move.z_from_mm - kHeightSlackMm && length > descent_.length_mm) {
      descent_.length_mm = length;
      descent_.line = move.line;
    }
    const auto above = static_cast<float>(move.z_to_mm - std::max(from_, to_));
    if (above >= lowest_.above_mm) return;
    lowest_.above_mm = above;
    lowest_.line = move.line;
  }

  void Finish() {
    if (descent_.line != 0) seen_.descents.push_back(descent_);
    if (lowest_.line != 0) seen_.lowest.push_back(lowest_);
  }

 private:
  const double from_;
  const double to_;
  Observations& seen_;
  LowestTravel lowest_;
  Descent descent_;
};

// How many moves at the beginning of `link`, which ends at another height, go on along the path.
uint32_t TailOf(const TraceChunk& chunk, uint32_t link) {
  const TraceMove& first = chunk.MovesOf(link).front();
  if (link == 0 || RiseOf(first.z_from_mm, chunk.paths[link].z_mm) == TravelRise::kLevel) return 0;
  std::vector<Piece> pieces;
  AppendPieces(chunk, link - 1, pieces);
  return LayerPair::TailMoves(chunk, link - 1, pieces);
}

void Observe(const LayerPair& layer, const TraceChunk& chunk, uint32_t link, bool only_new,
             Observations& seen) {
  const absl::Span<const TraceMove> moves = chunk.MovesOf(link);
  if (moves.empty()) return;
  if (!moves.front().in_print) return ObserveFirstTravel(layer, moves, seen);
  LinkHeights heights(moves.front().z_from_mm, chunk.paths[link].z_mm, layer.index(), seen);
  // A new departure, or tail, is as high as the path before; those of the original are examples.
  const TraceMove* departure = only_new ? DepartureOf(chunk, link) : nullptr;
  const uint32_t tail = only_new ? TailOf(chunk, link) : 0;
  for (const TraceMove& move : moves.subspan(tail)) {
    if (only_new && layer.IsKnown(move)) continue;
    if (&move != departure) heights.NoteDepth(move);
  }
  heights.Finish();
}

void CompareDescents(const Observations& was, const Observations& is,
                     std::vector<Finding>& breaks) {
  std::array<Descent, static_cast<size_t>(TravelRise::kCount)> known;
  for (const Descent& descent : was.descents) {
    Descent& longest = known[static_cast<size_t>(descent.rise)];
    if (descent.length_mm > longest.length_mm) longest = descent;
  }
  for (const Descent& descent : is.descents) {
    const Descent& longest = known[static_cast<size_t>(descent.rise)];
    if (descent.length_mm <= longest.length_mm + kLeastTravelMm) continue;
    breaks.push_back(
        {VerifyRule::kLifts, longest.line, descent.line, descent.layer,
         absl::StrFormat("the head descends over %.2f mm of travel; in the original over "
                         "%.2f mm at most",
                         descent.length_mm, longest.length_mm)});
  }
}

void CompareFirstTravel(const Observations& was, const Observations& is,
                        std::vector<Finding>& breaks) {
  const auto compare = [&breaks](const ExtremePoint& had, const ExtremePoint& has, double side,
                                 const char* leads) {
    if (had.line == 0 || has.line == 0 || side * (has.z_mm - had.z_mm) <= kHeightSlackMm) return;
    breaks.push_back({VerifyRule::kLifts, had.line, has.line, has.layer,
                      absl::StrFormat("travel from the start script %s to Z%.3f; in the original "
                                      "to Z%.3f",
                                      leads, has.z_mm, had.z_mm)});
  };
  compare(was.first_highest, is.first_highest, 1, "rises");
  compare(was.first_lowest, is.first_lowest, -1, "descends");
}

}  // namespace

void ObserveHeights(const LayerPair& layer, LayerFindings& findings) {
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    if (layer.Ended()) return;
    Observe(layer, layer.was(), link, false, findings.was);
  }
  for (uint32_t link = layer.first_path_is(); link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    Observe(layer, layer.is(), link, true, findings.is);
  }
}

void CompareHeights(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  CompareFirstTravel(was, is, breaks);
  CompareDescents(was, is, breaks);
  std::array<LowestTravel, static_cast<size_t>(TravelRise::kCount)> known;
  for (const LowestTravel& travel : was.lowest) {
    LowestTravel& lowest = known[static_cast<size_t>(travel.rise)];
    if (travel.above_mm < lowest.above_mm) lowest = travel;
  }
  for (const LowestTravel& travel : is.lowest) {
    const LowestTravel& lowest = known[static_cast<size_t>(travel.rise)];
    if (travel.above_mm >= lowest.above_mm - kHeightSlackMm) continue;
    breaks.push_back(
        {VerifyRule::kLifts, lowest.line, travel.line, travel.layer,
         absl::StrFormat("travel is %.3f mm below the paths that it connects; in the original "
                         "%.3f mm at most",
                         -travel.above_mm, -lowest.above_mm)});
  }
}

}  // namespace traverse::gcode
