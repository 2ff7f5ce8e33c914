#include "client/gcode/verify/findings.h"

#include <algorithm>

#include "client/gcode/verify/match/slacks.h"

namespace traverse::gcode {
namespace {

template <typename Map>
void AppendSeen(const Map& other, Map& map) {
  for (const auto& [key, seen] : other) {
    const auto [known, added] = map.try_emplace(key, seen);
    if (added) continue;
    Seen& own = known->second;
    own.longest_mm = std::max(own.longest_mm, seen.longest_mm);
    if (own.others.size() >= VerifyReport::kMostBreaks) continue;
    own.others.push_back({seen.line, seen.layer});
    own.others.insert(own.others.end(), seen.others.begin(), seen.others.end());
  }
}

}  // namespace

void AddAt(const Seen& seen, Finding finding, std::vector<Finding>& breaks) {
  const auto add = [&](uint32_t line, int64_t layer) {
    finding.optimised_line = line;
    finding.layer = layer;
    breaks.push_back(finding);
  };
  add(seen.line, seen.layer);
  for (const Seen::Place& place : seen.others) add(place.line, place.layer);
}

bool LiftHeights::Have(int64_t um, bool is_level) const {
  for (int64_t near = um - kSlackUm; near <= um + kSlackUm; ++near) {
    if (level.contains(near)) return true;
    if ((!is_level || level.empty()) && other.contains(near)) return true;
  }
  return false;
}

void LiftLog::Append(const LiftLog& other) {
  const auto shift = static_cast<uint32_t>(pieces.size());
  pieces.insert(pieces.end(), other.pieces.begin(), other.pieces.end());
  for (size_t kind = 0; kind < kTravelKinds; ++kind) {
    for (TravelProfile travel : other.travels[kind]) {
      travel.first += shift;
      travel.end += shift;
      travels[kind].push_back(travel);
    }
  }
}

void Observations::Append(const Observations& other) {
  for (size_t kind = 0; kind < accelerations.size(); ++kind) {
    AppendSeen(other.accelerations[kind], accelerations[kind]);
  }
  parts.Append(other.parts);
  new_links.insert(new_links.end(), other.new_links.begin(), other.new_links.end());
  primes.Append(other.primes);
  AppendSeen(other.heights.level, heights.level);
  AppendSeen(other.heights.other, heights.other);
  slopes.insert(other.slopes.begin(), other.slopes.end());
  stated.insert(stated.end(), other.stated.begin(), other.stated.end());
  if (other.first_highest.line != 0) first_highest = other.first_highest;
  if (other.first_lowest.line != 0) first_lowest = other.first_lowest;
  lowest.insert(lowest.end(), other.lowest.begin(), other.lowest.end());
  descents.insert(descents.end(), other.descents.begin(), other.descents.end());
  travel_lengths.insert(travel_lengths.end(), other.travel_lengths.begin(),
                        other.travel_lengths.end());
  travels_to_layers.insert(travels_to_layers.end(), other.travels_to_layers.begin(),
                           other.travels_to_layers.end());
  detours.insert(detours.end(), other.detours.begin(), other.detours.end());
  departs_inside |= other.departs_inside;
  departures_outside += other.departures_outside;
  retractions_outside += other.retractions_outside;
  lost_departures.insert(lost_departures.end(), other.lost_departures.begin(),
                         other.lost_departures.end());
  pokes.insert(pokes.end(), other.pokes.begin(), other.pokes.end());
  long_travels.insert(long_travels.end(), other.long_travels.begin(), other.long_travels.end());
  lifts.Append(other.lifts);
  wipes.insert(wipes.end(), other.wipes.begin(), other.wipes.end());
}

}  // namespace traverse::gcode
