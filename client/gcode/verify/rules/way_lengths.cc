// No way with an open nozzle is much longer than the longest one of the original, whatever it
// crosses, nor leads to another layer where none does; and none winds more than ways of the
// original do.

#include <algorithm>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/tails.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// Where slicers retract by what a way crosses, ways that cross nothing may come out a little
// longer.
constexpr float kOpenSlackMm = 1.0f;
constexpr float kOpenFactor = 2.0f;
constexpr float kShortestMm = 0.5f;
constexpr double kSamePointMm = 0.01;
constexpr float kWindingSlackMm = 2.0f;
constexpr float kWindingFactor = 3.0f;

// The way in `link`; of length 0 if there is none, or if only what is new counts and nothing is.
WayLength LengthOf(const LayerPair& layer, const TraceChunk& chunk, uint32_t link, uint32_t skipped,
                   bool only_new) {
  const TraceLink& traced = chunk.links[link];
  WayLength way;
  way.layer = layer.index();
  bool known = true;
  const TraceMove* first = nullptr;
  const TraceMove* last = nullptr;
  for (uint32_t m = traced.first_move + skipped; m < traced.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (move.kind != MoveKind::kTravel || !move.in_print) continue;
    if (first == nullptr) first = &move;
    way.turns_back |= last != nullptr && move.length_mm() > kShortestMm &&
                      DistanceOf(move.to, last->from) < kSamePointMm;
    last = &move;
    const auto length = static_cast<float>(move.length_mm());
    way.length_mm += length;
    if (move.open) way.open_mm += length;
    if (layer.IsKnown(move)) continue;
    if (known) way.line = move.line;
    known = false;
  }
  if (first == nullptr || traced.scripted || (only_new && known)) return {};
  if (way.line == 0) way.line = first->line;
  way.to_layer = traced.new_layer && way.open_mm > 0;
  way.excess_mm = way.length_mm - static_cast<float>(DistanceOf(first->from, last->to));
  return way;
}

void Observe(const LayerPair& layer, const Tails& tails, bool original, Observations& seen) {
  const TraceChunk& chunk = original ? layer.was() : layer.is();
  const uint32_t first = original ? layer.first_path_was() : layer.first_path_is();
  const uint32_t end = original ? layer.end_path_was() : layer.end_path_is();
  WayLength open;
  WayLength winding;
  WayLength open_to_layer;
  WayLength back;
  for (uint32_t link = first; link < end; ++link) {
    const WayLength way = LengthOf(layer, chunk, link, tails.At(link), !original);
    if (way.open_mm > open.open_mm) open = way;
    if (way.excess_mm > winding.excess_mm) winding = way;
    if (way.turns_back) back = way;
    if (way.to_layer && way.open_mm > kShortestMm) open_to_layer = way;
  }
  if (back.turns_back) seen.way_lengths.push_back(back);
  if (open_to_layer.to_layer) seen.way_lengths.push_back(open_to_layer);
  for (const WayLength& way : {open, winding}) {
    if (way.line != 0) seen.way_lengths.push_back(way);
  }
}

}  // namespace

void ObserveWayLengths(const LayerPair& layer, LayerFindings& findings) {
  Observe(layer, Tails(layer, true), true, findings.was);
  Observe(layer, Tails(layer, false), false, findings.is);
}

void CompareWayLengths(const Observations& was, const Observations& is,
                       std::vector<Finding>& breaks) {
  WayLength open;
  WayLength winding;
  bool open_to_layers = false;
  bool turn_back = false;
  for (const WayLength& way : was.way_lengths) {
    turn_back |= way.turns_back;
    open_to_layers |= way.to_layer;
    if (way.open_mm > open.open_mm) open = way;
    if (way.excess_mm > winding.excess_mm) winding = way;
  }
  for (const WayLength& way : is.way_lengths) {
    if (way.turns_back && !turn_back) {
      breaks.push_back({VerifyRule::kBounds, 0, way.line, way.layer,
                        "a way leads back to where it was, as none of the original"});
      continue;
    }
    if (way.to_layer && !open_to_layers) {
      breaks.push_back({VerifyRule::kOpenWays, 0, way.line, way.layer,
                        "an open way to another layer, as the original has none"});
      continue;
    }
    if (way.open_mm > open.open_mm * kOpenFactor + kOpenSlackMm) {
      breaks.push_back({VerifyRule::kOpenWays, open.line, way.line, way.layer,
                        absl::StrFormat("an open way of %.2f mm; the longest of the original has "
                                        "%.2f mm",
                                        way.open_mm, open.open_mm)});
    }
    if (way.excess_mm > winding.excess_mm * kWindingFactor + kWindingSlackMm) {
      breaks.push_back({VerifyRule::kBounds, winding.line, way.line, way.layer,
                        absl::StrFormat("a way leads %.2f mm farther than straight; the most of "
                                        "the original is %.2f mm",
                                        way.excess_mm, winding.excess_mm)});
    }
  }
}

}  // namespace traverse::gcode
