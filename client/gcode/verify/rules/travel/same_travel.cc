// Travel between the same two points as in the original: it retracts where the original retracts,
// whatever it crosses; and where that retracts and lifts, it rises as high.

#include <algorithm>

#include "absl/container/flat_hash_map.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/travel_ends.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr double kShortestTravelMm = 0.5;  // shorter travel comes from rounding
constexpr double kApexSlackMm = 0.003;

enum class Nozzle : uint8_t { kNoTravel, kOpen, kRetracted };

// Whether the travel in `link`, from path to path, is retracted; not if part of it is unretracted.
Nozzle NozzleIn(const LayerPair& layer, const TraceChunk& chunk, uint32_t link, bool new_ones) {
  const TraceLink& traced = chunk.links[link];
  if (link == 0 || traced.new_layer || traced.scripted) return Nozzle::kNoTravel;
  if (DistanceOf(chunk.EndOf(chunk.paths[link - 1]), chunk.paths[link].start) < kShortestTravelMm) {
    return Nozzle::kNoTravel;
  }
  Nozzle nozzle = Nozzle::kNoTravel;
  for (uint32_t m = traced.first_move; m < traced.end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (move.kind != MoveKind::kTravel || !move.in_print) continue;
    if (new_ones && layer.IsKnown(move)) continue;
    if (move.open && move.length_mm() > kShortestTravelMm) return Nozzle::kOpen;
    if (!move.open) nozzle = Nozzle::kRetracted;
  }
  return nozzle;
}

// How far above the paths that it connects the retracted travel in `link` rises.
double ApexOf(const TraceChunk& chunk, uint32_t link) {
  const double base = std::max(chunk.paths[link - 1].z_mm, chunk.paths[link].z_mm);
  double apex = 0;
  for (uint32_t m = chunk.links[link].first_move; m < chunk.links[link].end_move; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (move.kind != MoveKind::kTravel || move.open) continue;
    apex = std::max(apex, std::max(move.z_from_mm, move.z_to_mm) - base);
  }
  return apex;
}

uint32_t LineOf(const TraceChunk& chunk, uint32_t link) {
  return chunk.moves[chunk.links[link].first_move].line;
}

// The original's travel that is retracted all along, by its ends: of several the lowest.
absl::flat_hash_map<uint64_t, uint32_t> RetractedTravels(const LayerPair& layer) {
  const TraceChunk& was = layer.was();
  absl::flat_hash_map<uint64_t, uint32_t> travels;
  for (uint32_t link = layer.first_path_was() + 1; link < layer.end_path_was(); ++link) {
    if (NozzleIn(layer, was, link, false) != Nozzle::kRetracted) continue;
    const auto [found, added] = travels.try_emplace(EndsOf(was, link), link);
    if (!added && ApexOf(was, link) < ApexOf(was, found->second)) found->second = link;
  }
  return travels;
}

}  // namespace

void CheckSameTravels(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  const TraceChunk& is = layer.is();
  std::vector<uint32_t> changed;  // links
  for (uint32_t link = layer.first_path_is() + 1; link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    if (layer.IsHidden(link)) continue;
    if (NozzleIn(layer, is, link, true) != Nozzle::kNoTravel) changed.push_back(link);
  }
  if (changed.empty()) return;
  const absl::flat_hash_map<uint64_t, uint32_t> retracted = RetractedTravels(layer);
  for (const uint32_t link : changed) {
    const auto same = retracted.find(EndsOf(is, link));
    if (same == retracted.end()) continue;
    const auto report = [&](VerifyRule rule, std::string what) {
      findings.breaks.push_back(
          {rule, LineOf(was, same->second), LineOf(is, link), layer.index(), std::move(what)});
    };
    if (NozzleIn(layer, is, link, true) == Nozzle::kOpen) {
      report(VerifyRule::kOpenTravels, "travel without a retraction where the original retracts");
      continue;
    }
    const double lift = ApexOf(was, same->second);
    const double apex = ApexOf(is, link);
    if (apex >= lift - kApexSlackMm) continue;
    report(
        VerifyRule::kLifts,
        absl::StrFormat("travel %.3f mm above the layer that is lifted by %.3f mm in the original",
                        apex, lift));
  }
}

}  // namespace traverse::gcode
