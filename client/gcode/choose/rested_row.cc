#include "client/gcode/choose/rested_row.h"

#include <algorithm>
#include <limits>

namespace traverse::gcode {
namespace {

constexpr double kUnreachable = std::numeric_limits<double>::infinity();

// A choice: 0 is the file's own order, and `turn` + 1 the others.
struct Candidate {
  IslandTimes times;
  TravelTotals totals;
  Point begin;
  Point end;
  double score = kUnreachable;  // of the best row up to it
};

class RowSearch {
 public:
  RowSearch(const IslandRests& rests, const std::vector<TurnedLayer>& layers,
            double crossing_seconds)
      : rests_(rests), layers_(layers), crossing_seconds_(crossing_seconds) {}

  std::vector<std::optional<uint32_t>> Find() {
    std::vector<std::vector<uint32_t>> from;
    std::vector<Candidate> before;
    for (size_t layer = 0; layer < layers_.size(); ++layer) {
      std::vector<Candidate> candidates = CandidatesOf(layer);
      from.emplace_back(candidates.size(), 0);
      for (uint32_t c = 0; c < candidates.size(); ++c) {
        Reach(layer, before, c, candidates[c], from.back()[c]);
      }
      before = std::move(candidates);
    }
    const auto best = std::ranges::min_element(before, {}, &Candidate::score);
    auto choice = static_cast<uint32_t>(best - before.begin());
    std::vector<std::optional<uint32_t>> row(layers_.size());
    for (size_t layer = layers_.size(); layer-- > 0;) {
      if (choice > 0) row[layer] = choice - 1;
      choice = from[layer][choice];
    }
    return row;
  }

 private:
  std::vector<Candidate> CandidatesOf(size_t layer) const {
    const TurnedLayer& of = layers_[layer];
    std::vector<Candidate> candidates;
    candidates.push_back({of.given_times, of.given, of.given_begin, of.given_end});
    for (size_t turn = 0; turn < of.turns.size(); ++turn) {
      candidates.push_back(
          {rests_.TimesOf(layer, of.turns.OrderOf(turn), of.first_block, of.turns.MomentsOf(turn)),
           of.turns.TotalsOf(turn), of.begin[turn], of.end[turn]});
    }
    return candidates;
  }

  // The best way to candidate `c` of `layer`.
  void Reach(size_t layer, const std::vector<Candidate>& before, uint32_t c, Candidate& candidate,
             uint32_t& from) const {
    const TurnedLayer& of = layers_[layer];
    const double inside = candidate.totals.seconds +
                          crossing_seconds_ * static_cast<double>(candidate.totals.crossings);
    if (layer == 0) {
      candidate.score = inside;
      return;
    }
    for (uint32_t b = 0; b < before.size(); ++b) {
      const bool as_given = b == 0 && c == 0;
      const double mm = as_given ? of.given_travel_mm : Distance(before[b].end, candidate.begin);
      const double seconds =
          as_given ? of.given_travel_seconds : of.turns.clock().TravelSeconds(mm, 0);
      const double score = before[b].score + inside + mm / of.turns.clock().travel_mm_s;
      if (!(score < candidate.score)) continue;
      if (!as_given && rests_.TooShort(layer, before[b].times, {&candidate.times, seconds})) {
        continue;
      }
      candidate.score = score;
      from = b;
    }
  }

  const IslandRests& rests_;
  const std::vector<TurnedLayer>& layers_;
  const double crossing_seconds_;
};

}  // namespace

std::vector<std::optional<uint32_t>> RestedRow(const IslandRests& rests,
                                               const std::vector<TurnedLayer>& layers,
                                               double crossing_seconds) {
  return RowSearch(rests, layers, crossing_seconds).Find();
}

}  // namespace traverse::gcode
