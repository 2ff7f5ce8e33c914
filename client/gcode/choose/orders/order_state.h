// An order of a layer during changes: the totals of its travel moves, and the allowed changes.
//
//   ... p | A ... | B .. | q ...   ->   ... p | B .. | A ... | q ...   two runs change places
//   ... p | B .. | q ...           ->   ... p | B backwards | q ...    a run is reversed
//   ... p | b | q ...              ->   ... p | b' | q ...             a path begins elsewhere

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_STATE_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_STATE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/gcode/choose/orders/order_merge.h"
#include "client/gcode/link/travel_totals.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/plan/layer_freedom.h"

namespace traverse::gcode {

// A run of places [begin, end) of an order.
struct PlaceRun {
  size_t begin = 0;
  size_t end = 0;
  bool turned = false;                 // backwards, with each path reversed
  std::optional<uint32_t> entry = {};  // of its only path, which begins there

  size_t size() const { return end - begin; }
};

// Runs that adjoin, in the order in which they follow each other after the change; the second may
// be empty.
using PlaceRuns = std::array<PlaceRun, 2>;

// For each path the paths that must come before it, and those that must come after it.
struct PathPairs {
  explicit PathPairs(const LayerFreedom& freedom);

  std::vector<std::vector<uint32_t>> earlier;
  std::vector<std::vector<uint32_t>> later;
};

// `placement` in the other direction, if it is an open path.
inline Placement Turned(Placement placement) {
  if (!placement.closed) placement.entry = 1 - placement.entry;
  return placement;
}

// Where a path with that outline begins and ends, as it is placed.
inline Point BeginOf(const Outline& outline, const Placement& placement) {
  if (placement.closed) return outline.points[placement.entry];
  return placement.as_given() ? outline.points.front() : outline.points.back();
}
inline Point EndOf(const Outline& outline, const Placement& placement) {
  return BeginOf(outline, Turned(placement));
}

class OrderState {
 public:
  // `pairs` are those of `freedom`. `groups` count instead of freedom.group. The path with index 0
  // is block `first_block`. All but `begun` outlive the state. REQUIRES: `begun` has each path of
  // `freedom` once.
  OrderState(LayerOrder begun, uint32_t first_block, const LayerFreedom& freedom,
             const std::vector<uint32_t>& groups, const PathPairs& pairs,
             const TravelEstimate& estimate, const OrderMerger& judge);

  size_t size() const { return order_.size(); }
  const LayerOrder& order() const { return order_; }
  const Placement& At(size_t place) const { return order_[place]; }
  uint32_t PathAt(size_t place) const { return order_[place].block - first_block_; }
  size_t PlaceOf(uint32_t path) const { return place_[path]; }
  const PathRule& RuleAt(size_t place) const { return freedom_.rules[PathAt(place)]; }

  // The judge's score: seconds, including the price of crossings.
  double Score() const { return judge_.Score(totals_); }
  double ScoreOfTravelTo(size_t place) const { return judge_.Score(travels_[place]); }
  double ScoreOf(size_t place, const Placement& from, const Placement& to) {
    return judge_.Score(Ask(place, from, to));
  }

  // The number of estimates asked for.
  size_t asked() const { return asked_; }

  // Whether the paths at [begin, middle) and at [middle, end) may change places, and whether those
  // at [begin, end) may be reversed. The first and the last path always stay.
  bool MayExchange(size_t begin, size_t middle, size_t end) const;
  bool MayTurn(size_t begin, size_t end) const;

  // Applies `runs`, which together are the places [begin, end), if the judge prefers the result, or
  // at `any_cost`. True if applied. REQUIRES: the change is allowed; 0 < begin, end < size().
  bool DoIfBetter(size_t begin, size_t end, const PlaceRuns& runs, bool any_cost = false);

  // Paths next to a change since the last call.
  std::vector<uint32_t> TakeTouched();

  // Keeps the order if it is better than the last kept one, otherwise returns to that. True if it
  // was kept. The first order kept is the one at the beginning.
  bool KeepIfBetter();

 private:
  TravelTotals Ask(size_t place, const Placement& from, const Placement& to);
  bool MayCut(size_t place) const;
  bool AnyBetween(const std::vector<uint32_t>& paths, size_t begin, size_t end) const;
  Placement PlacedIn(const PlaceRun& run, size_t k) const;
  static size_t NewTravels(const PlaceRun& run);
  TravelTotals TotalsWith(size_t begin, size_t end, const PlaceRuns& runs);

  const uint32_t first_block_;
  const LayerFreedom& freedom_;
  const std::vector<uint32_t>& groups_;  // [path]
  const PathPairs& pairs_;
  const TravelEstimate& estimate_;
  const OrderMerger& judge_;

  LayerOrder order_;
  std::vector<TravelTotals> travels_;  // [place] the travel to it
  std::vector<size_t> place_;          // [path]
  TravelTotals totals_;

  LayerOrder kept_order_;
  std::vector<TravelTotals> kept_travels_;
  TravelTotals kept_totals_;
  size_t changed_begin_ = 0;  // places that may differ from the kept order
  size_t changed_end_ = 0;

  std::vector<uint32_t> touched_;
  size_t asked_ = 0;
  std::vector<TravelTotals> asked_travels_;  // scratch: the new travel moves of a change
  LayerOrder run_;  // and the paths at the changed places, and all their travel
  std::vector<TravelTotals> new_travels_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_STATE_H_
