// The acceleration of each travel, wipe, lift and retraction is that of the same kind of move
// within the print. Their feed rates are those of parts of travel (travel/made_of_parts.cc).

#include <algorithm>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Unretracted travel is a kind of its own, after those of MoveKind.
constexpr auto kOpenTravel = static_cast<size_t>(MoveKind::kCount);

size_t KindOf(const TraceMove& move) {
  return move.kind == MoveKind::kTravel && move.open ? kOpenTravel : static_cast<size_t>(move.kind);
}

std::string KindName(size_t kind) {
  return std::string(kind == kOpenTravel ? "unretracted travel"
                                         : MoveKindName(static_cast<MoveKind>(kind)));
}

void Note(const LayerPair& layer, const TraceMove& move, Observations& observed) {
  constexpr size_t kMostOfALayer = 64;
  Seen& seen = observed.accelerations[KindOf(move)][move.acceleration];
  if (seen.places.size() <= kMostOfALayer) seen.places.push_back({move.line, layer.index()});
  if (move.sideways()) {
    seen.longest_mm = std::max(seen.longest_mm, static_cast<float>(move.length_mm()));
  }
}

using LongestTravels = absl::flat_hash_map<uint64_t, float>;  // by acceleration, mm

LongestTravels LongestOf(const LayerPair& layer) {
  LongestTravels longest;
  const TraceChunk& chunk = layer.was();
  for (const TraceMove& move : chunk.MovesOfLinks(layer.first_path_was(), layer.end_path_was())) {
    if (move.kind != MoveKind::kTravel || !move.in_print) continue;
    float& of_one = longest[move.acceleration];
    of_one = std::max(of_one, static_cast<float>(move.length_mm()));
  }
  return longest;
}

// All travel to paths of the same settings has the same acceleration, as where those settings stand
// before the travel: then it says nothing of the length.
bool AcceleratesByPath(const LayerPair& layer) {
  const TraceChunk& chunk = layer.was();
  absl::flat_hash_map<uint64_t, uint64_t> of_path;
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    for (const TraceMove& move : chunk.MovesOf(link, layer.Side(true).TailOf(link))) {
      if (move.kind != MoveKind::kTravel || !move.in_print) continue;
      const auto known = of_path.try_emplace(chunk.paths[link].acceleration, move.acceleration);
      if (known.first->second != move.acceleration) return false;
    }
  }
  return true;
}

// Some slicers accelerate less on short travel: true if the layer has travel as long as `move` with
// another acceleration, and only much shorter travel with this one.
bool IsTooLong(const TraceMove& move, const LongestTravels& longest) {
  if (move.kind != MoveKind::kTravel) return false;
  const auto length = static_cast<float>(move.length_mm());
  const auto own = longest.find(move.acceleration);
  const float most = own == longest.end() ? 0 : own->second;
  if (!IsMuchLonger(length, most)) return false;
  return std::ranges::any_of(longest, [&](const auto& other) {
    return other.first != move.acceleration && other.second >= length;
  });
}

// Moves of `link` that the original does not have in this layer. The gap of a loop that begins
// elsewhere belongs to the loop, and is crossed as fast as that is printed.
bool IsNew(const LayerPair& layer, uint32_t link, const TraceMove& move) {
  if (move.firmware || layer.IsKnown(move)) return false;
  const TraceChunk& is = layer.is();
  return move.kind != MoveKind::kTravel || !move.open || link == 0 ||
         move.length_mm() > LoopGapMm(is, link - 1) || move.feed != is.paths[link - 1].feed;
}

}  // namespace

void ObserveSpeeds(const LayerPair& layer, LayerFindings& findings) {
  const LongestTravels longest = AcceleratesByPath(layer) ? LongestTravels() : LongestOf(layer);
  layer.ForEachLink([&](const LayerSide& side, uint32_t link) {
    // At unknown lines every step is that of the original there: see CheckScriptedTravels.
    if (side.chunk.links[link].scripted) return;
    for (const TraceMove& move : side.chunk.MovesOf(link, side.TailOf(link))) {
      if (!move.in_print || (!side.original && !IsNew(layer, link, move))) continue;
      Note(layer, move, findings.Of(side));
      if (side.original || !IsTooLong(move, longest)) continue;
      findings.is.long_travels.push_back(
          {move.acceleration, static_cast<float>(move.length_mm()), {move.line, layer.index()}});
    }
  });
}

// After the last path there are also moves of the end script, which are no example for the print.
void ObserveLastSpeeds(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  const TraceChunk& is = layer.is();
  absl::flat_hash_set<uint64_t> accelerations;
  const auto key = [](const TraceMove& move) { return Mix(KindOf(move), move.acceleration); };
  for (const TraceMove& move : was.MovesOfLast()) accelerations.insert(key(move));
  for (const TraceMove& move : is.MovesOfLast()) {
    if (move.firmware || layer.IsKnown(move) || accelerations.contains(key(move))) continue;
    Note(layer, move, findings.is);
  }
}

namespace {

// The accelerations that moves of `kind` may have. Slicers treat retracted and
// unretracted travel alike; other moves between paths have that of the path before, or
// that of travel.
bool IsKnownAcceleration(const Observations& was, size_t kind, uint64_t acceleration) {
  constexpr auto kTravel = static_cast<size_t>(MoveKind::kTravel);
  for (const size_t like : {kind, kTravel, kOpenTravel}) {
    if (was.accelerations[like].contains(acceleration)) return true;
  }
  return kind != kTravel && kind != kOpenTravel && was.deposit_accelerations.contains(acceleration);
}

// The longest travel with `acceleration`.
float LongestUnder(const Observations& was, uint64_t acceleration) {
  float longest = 0;
  for (const size_t kind : {static_cast<size_t>(MoveKind::kTravel), kOpenTravel}) {
    const auto found = was.accelerations[kind].find(acceleration);
    if (found != was.accelerations[kind].end()) {
      longest = std::max(longest, found->second.longest_mm);
    }
  }
  return longest;
}

// Where the first of them was seen; 0 if there is none.
uint32_t FirstLineOf(const absl::flat_hash_map<uint64_t, Seen>& accelerations) {
  uint32_t line = 0;
  for (const auto& [acceleration, seen] : accelerations) {
    if (line == 0 || seen.places[0].line < line) line = seen.places[0].line;
  }
  return line;
}

void CompareLengths(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  for (const LongTravel& travel : is.long_travels) {
    const float longest = LongestUnder(was, travel.acceleration);
    if (longest <= 0 || !IsMuchLonger(travel.length_mm, longest)) continue;
    breaks.push_back({VerifyRule::kSpeeds, 0, travel.at,
                      absl::StrFormat("travel of %.2f mm with an acceleration that the original "
                                      "does not use for travel longer than %.2f mm",
                                      travel.length_mm, longest)});
  }
}

}  // namespace

void CompareSpeeds(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  CompareLengths(was, is, breaks);
  for (size_t kind = 0; kind < was.accelerations.size(); ++kind) {
    const uint32_t first_line = FirstLineOf(was.accelerations[kind]);
    for (const auto& [acceleration, seen] : is.accelerations[kind]) {
      if (IsKnownAcceleration(was, kind, acceleration)) continue;
      for (const Place& place : seen.places) {
        breaks.push_back({VerifyRule::kSpeeds, first_line, place,
                          absl::StrFormat("%s with an acceleration that none in the original has",
                                          KindName(kind))});
      }
    }
  }
}

}  // namespace traverse::gcode
