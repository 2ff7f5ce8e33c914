#include "client/gcode/choose/rows/rested_row.h"

#include <utility>

#include "client/gcode/choose/rows/cheapest_row.h"

namespace traverse::gcode {
namespace {

// A choice: 0 is the file's own order, and `turn` + 1 the others.
struct Candidate {
  IslandTimes times;
  TravelTotals totals;
  Point begin;
  Point end;
};

std::vector<Candidate> CandidatesOf(const IslandRests& rests, size_t layer,
                                    const TurnedLayer& turned) {
  std::vector<Candidate> candidates = {
      {turned.given_times, turned.given, turned.given_begin, turned.given_end}};
  for (size_t turn = 0; turn < turned.turns.size(); ++turn) {
    candidates.push_back({rests.TimesOf(layer, turned.turns.OrderOf(turn), turned.first_block,
                                        turned.turns.MomentsOf(turn)),
                          turned.turns.TotalsOf(turn), turned.begin[turn], turned.end[turn]});
  }
  return candidates;
}

}  // namespace

std::vector<std::optional<uint32_t>> RestedRow(const IslandRests& rests,
                                               const std::vector<TurnedLayer>& layers,
                                               double crossing_seconds) {
  CheapestRow cheapest;
  std::vector<Candidate> before;
  for (size_t layer = 0; layer < layers.size(); ++layer) {
    std::vector<Candidate> here = CandidatesOf(rests, layer, layers[layer]);
    const LayerClock& clock = layers[layer].turns.clock();
    // In the file's own order it is as measured.
    const auto travel_mm = [&](uint32_t b, uint32_t c) {
      return b == 0 && c == 0 ? layers[layer].given_travel_mm
                              : Distance(before[b].end, here[c].begin);
    };
    cheapest.Extend(
        here.size(),
        [&](uint32_t b, uint32_t c, double up_to) {
          const double inside = here[c].totals.seconds +
                                crossing_seconds * static_cast<double>(here[c].totals.crossings);
          return up_to + inside + (layer > 0 ? travel_mm(b, c) / clock.travel_mm_s : 0);
        },
        [&](uint32_t b, uint32_t c) {
          if (layer == 0 || (b == 0 && c == 0)) return true;
          const double seconds = clock.TravelSeconds(travel_mm(b, c), 0);
          return !rests.TooShort(layer, before[b].times, {&here[c].times, seconds});
        });
    before = std::move(here);
  }
  std::vector<std::optional<uint32_t>> row;
  for (const uint32_t choice : cheapest.Choices()) {
    row.push_back(choice > 0 ? std::optional(choice - 1) : std::nullopt);
  }
  return row;
}

}  // namespace traverse::gcode
