#include "client/gcode/verify/findings.h"

namespace traverse::gcode {
namespace {

template <typename T>
void AppendTo(std::vector<T>& all, const std::vector<T>& other) {
  all.insert(all.end(), other.begin(), other.end());
}

void AppendTo(absl::flat_hash_map<uint64_t, Seen>& all,
              const absl::flat_hash_map<uint64_t, Seen>& other) {
  for (const auto& [key, seen] : other) {
    Seen& own = all[key];
    own.longest_mm = std::max(own.longest_mm, seen.longest_mm);
    if (own.places.size() <= VerifyReport::kMostBreaks) AppendTo(own.places, seen.places);
  }
}

void AppendTo(StatedHeights& all, const StatedHeights& other) {
  all.um.insert(other.um.begin(), other.um.end());
  if (all.first_line == 0) all.first_line = other.first_line;
}

}  // namespace

void Observations::Append(const Observations& other) {
  for (size_t kind = 0; kind < accelerations.size(); ++kind) {
    AppendTo(accelerations[kind], other.accelerations[kind]);
  }
  parts.Append(other.parts);
  AppendTo(new_links, other.new_links);
  primes.Append(other.primes);
  AppendTo(level_heights, other.level_heights);
  AppendTo(other_heights, other.other_heights);
  slopes.insert(other.slopes.begin(), other.slopes.end());
  AppendTo(stated, other.stated);
  if (other.first_highest.at.line != 0) first_highest = other.first_highest;
  if (other.first_lowest.at.line != 0) first_lowest = other.first_lowest;
  AppendTo(lowest, other.lowest);
  AppendTo(descents, other.descents);
  AppendTo(travel_lengths, other.travel_lengths);
  AppendTo(travels_to_layers, other.travels_to_layers);
  AppendTo(detours, other.detours);
  departs_inside |= other.departs_inside;
  departures_outside += other.departures_outside;
  retractions_outside += other.retractions_outside;
  AppendTo(lost_departures, other.lost_departures);
  poked |= other.poked;
  AppendTo(pokes, other.pokes);
  AppendTo(long_travels, other.long_travels);
  for (size_t kind = 0; kind < kTravelKinds; ++kind) AppendTo(travels[kind], other.travels[kind]);
  AppendTo(wipes, other.wipes);
}

}  // namespace traverse::gcode
