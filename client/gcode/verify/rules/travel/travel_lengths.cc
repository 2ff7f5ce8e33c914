// No unretracted travel is much longer than the longest of the original, whatever it crosses. None
// leads to another layer if none does there, or if the original retracts on the travel to that
// layer, and on even shorter travel, or leads to no layer as far without a retraction. And none
// winds more than the original's travel.

#include <algorithm>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/departures.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr float kWindingFactor = 3.0f;

// The move with which the head goes down to a path that lies lower than the one before: it has to
// do so where nothing stands in its way (travel_heights.cc). Nothing if the path does not.
const TraceMove* SinkOf(const TraceChunk& chunk, uint32_t link) {
  const absl::Span<const TraceMove> moves = chunk.MovesOf(link);
  if (moves.empty()) return nullptr;
  const double printed = moves.front().z_from_mm - kOneHeightMm;
  if (chunk.paths[link].z_mm >= printed) return nullptr;
  const auto sink = std::ranges::find_if(
      moves, [printed](const TraceMove& move) { return move.z_to_mm < printed; });
  return sink == moves.end() ? nullptr : &*sink;
}

// The travel in `link`; of length 0 if there is none, or none that counts.
TravelLength LengthOf(const LayerPair& layer, const LayerSide& side, uint32_t link) {
  const TraceChunk& chunk = side.chunk;
  const bool hides = !side.original && layer.IsHidden(link);
  TravelLength travel{.to_layer = chunk.links[link].new_layer, .at = {0, layer.index()}};
  const TraceMove* first = nullptr;
  const TraceMove* last = nullptr;
  const TraceMove* sink = SinkOf(chunk, link);
  const TraceMove* departure = DepartureOf(chunk, link);  // retracts right behind it
  for (const TraceMove& move : chunk.MovesOf(link, side.TailOf(link))) {
    travel.retracts |= Retracts(move);
    if (move.kind != MoveKind::kTravel || !move.in_print) continue;
    if (first == nullptr) first = &move;
    // The next path may begin where the one before it ends and a short move leads away.
    const double least_turn = last == first ? kLeastTravelMm : kLeastMoveMm;
    travel.turns_back |= last != nullptr && move.length_mm() > least_turn &&
                         Distance(move.to, last->from) < kSamePointMm;
    last = &move;
    const auto length = static_cast<float>(move.length_mm());
    travel.length_mm += length;
    if (move.open && &move != departure && !hides) travel.open_mm += length;
    if (travel.at.line == 0 && layer.Counts(side, move)) travel.at.line = move.line;
  }
  if (travel.at.line == 0 || chunk.links[link].scripted) return {};
  const double straight = sink == nullptr
                              ? Distance(first->from, last->to)
                              : Distance(first->from, sink->from) + Distance(sink->from, last->to);
  travel.excess_mm = hides ? 0 : travel.length_mm - static_cast<float>(straight);
  return travel;
}

void ObserveTravelsToLayers(const LayerPair& layer, LayerFindings& findings) {
  const TravelLength was = LengthOf(layer, layer.Side(true), layer.first_path_was());
  TravelLength is = LengthOf(layer, layer.Side(false), layer.first_path_is());
  is.was_retracted = was.retracted_to_layer();
  is.was_retracting = was.retracts;
  if (was.to_layer && was.length_mm > 0) findings.was.travels_to_layers.push_back(was);
  if (is.to_layer && is.open_mm > 0) findings.is.travels_to_layers.push_back(is);
}

void Observe(const LayerPair& layer, const LayerSide& side, Observations& seen) {
  TravelLength open;
  TravelLength winding;
  TravelLength back;
  for (uint32_t link = side.first_path; link < side.end_path; ++link) {
    const TravelLength travel = LengthOf(layer, side, link);
    if (travel.open_mm > open.open_mm) open = travel;
    if (travel.excess_mm > winding.excess_mm) winding = travel;
    if (travel.turns_back) back = travel;
  }
  if (back.turns_back) seen.travel_lengths.push_back(back);
  for (const TravelLength& travel : {open, winding}) {
    if (travel.at.line != 0) seen.travel_lengths.push_back(travel);
  }
}

void CompareTravelsToLayers(const Observations& was, const Observations& is,
                            std::vector<Finding>& breaks) {
  bool any_open = false;
  float shortest_retracted = 1e9f;
  float longest_open = 0;
  for (const TravelLength& travel : was.travels_to_layers) {
    any_open |= travel.open_mm > kLeastTravelMm;
    if (travel.retracted_to_layer())
      shortest_retracted = std::min(shortest_retracted, travel.length_mm);
    if (!travel.retracts) longest_open = std::max(longest_open, travel.open_mm);
  }
  for (const TravelLength& travel : is.travels_to_layers) {
    if (travel.open_mm > kLeastTravelMm && !any_open) {
      breaks.push_back({VerifyRule::kOpenTravels, 0, travel.at,
                        "travel to another layer without a retraction, as the original has none"});
      continue;
    }
    if (travel.open_mm <= kLeastMoveMm) continue;
    const bool on_shorter =
        travel.was_retracted && travel.open_mm > shortest_retracted - kLeastMoveMm;
    const bool none_as_long =
        travel.was_retracting && !travel.retracts && travel.open_mm > longest_open + kLeastMoveMm;
    if (on_shorter || none_as_long) {
      breaks.push_back(
          {VerifyRule::kOpenTravels, 0, travel.at,
           absl::StrFormat("travel of %.2f mm to this layer without a retraction; the "
                           "original retracts there, and on %s",
                           travel.open_mm, on_shorter ? "shorter travel" : "all travel as long")});
    }
  }
}

}  // namespace

void ObserveTravelLengths(const LayerPair& layer, LayerFindings& findings) {
  Observe(layer, layer.Side(true), findings.was);
  Observe(layer, layer.Side(false), findings.is);
  ObserveTravelsToLayers(layer, findings);
}

void CompareTravelLengths(const Observations& was, const Observations& is,
                          std::vector<Finding>& breaks) {
  CompareTravelsToLayers(was, is, breaks);
  TravelLength open;
  TravelLength winding;
  bool turn_back = false;
  for (const TravelLength& travel : was.travel_lengths) {
    turn_back |= travel.turns_back;
    if (travel.open_mm > open.open_mm) open = travel;
    if (travel.excess_mm > winding.excess_mm) winding = travel;
  }
  for (const TravelLength& travel : is.travel_lengths) {
    if (travel.turns_back && !turn_back) {
      breaks.push_back({VerifyRule::kBounds, 0, travel.at,
                        "travel returns to where it was, as none does in the original"});
      continue;
    }
    if (IsMuchLonger(travel.open_mm, open.open_mm)) {
      breaks.push_back({VerifyRule::kOpenTravels, open.at.line, travel.at,
                        absl::StrFormat("travel of %.2f mm without a retraction; the longest such "
                                        "travel in the original has %.2f mm",
                                        travel.open_mm, open.open_mm)});
    }
    if (travel.excess_mm > winding.excess_mm * kWindingFactor + kLooseMm) {
      breaks.push_back(
          {VerifyRule::kBounds, winding.at.line, travel.at,
           absl::StrFormat(
               "travel is %.2f mm longer than a straight move; the most in the original is %.2f mm",
               travel.excess_mm, winding.excess_mm)});
    }
  }
}

}  // namespace traverse::gcode
