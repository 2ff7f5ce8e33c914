// An order of a layer while it is being changed: what its ways come to, and what may be changed.
//
//   ... p | A ... | B .. | q ...   ->   ... p | B .. | A ... | q ...   two runs change places
//   ... p | B .. | q ...           ->   ... p | B backwards | q ...    a run is turned round
//   ... p | b | q ...              ->   ... p | b' | q ...             a path is begun elsewhere

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ORDER_STATE_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ORDER_STATE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/gcode/choose/order_merge.h"
#include "client/gcode/plan/layer_freedom.h"
#include "client/gcode/write/placed_path.h"
#include "client/gcode/write/way_totals.h"

namespace traverse::gcode {

// A run of places [begin, end) of an order.
struct PlaceRun {
  size_t begin = 0;
  size_t end = 0;
  bool turned = false;                 // done backwards, each path the other way round
  std::optional<uint32_t> entry = {};  // of its one path, which is begun there

  size_t size() const { return end - begin; }
};

// Runs that stand one after the other, in the order in which they are done from now on; the second
// may be empty.
using PlaceRuns = std::array<PlaceRun, 2>;

// For each path, those that come before it, and those that come after it.
struct PathPairs {
  explicit PathPairs(const LayerFreedom& freedom);

  std::vector<std::vector<uint32_t>> earlier;
  std::vector<std::vector<uint32_t>> later;
};

class OrderState {
 public:
  // `pairs` are those of `freedom`. The path with index 0 is block `first_block`; all but `begun`
  // outlive the state. REQUIRES: `begun` has each path of `freedom` once.
  OrderState(LayerOrder begun, uint32_t first_block, const LayerFreedom& freedom,
             const PathPairs& pairs, const WayEstimate& estimate, const OrderMerger& judge);

  size_t size() const { return order_.size(); }
  const LayerOrder& order() const { return order_; }
  const Placement& At(size_t place) const { return order_[place]; }
  uint32_t PathAt(size_t place) const { return order_[place].block - first_block_; }
  size_t PlaceOf(uint32_t path) const { return place_[path]; }
  const PathRule& RuleAt(size_t place) const { return freedom_.rules[PathAt(place)]; }

  // By the judge: seconds, and what crossings count for.
  double Score() const { return judge_.Score(totals_); }
  double ScoreOfWayTo(size_t place) const { return judge_.Score(ways_[place]); }
  double ScoreOf(size_t place, const Placement& from, const Placement& to) {
    return judge_.Score(Ask(place, from, to));
  }

  // How many ways were asked for.
  size_t asked() const { return asked_; }

  // Whether what stands at [begin, middle) and at [middle, end) may change places, and what stands
  // at [begin, end) may be done backwards. The first and the last path always stay.
  bool MayExchange(size_t begin, size_t middle, size_t end) const;
  bool MayTurn(size_t begin, size_t end) const;

  // Does `runs`, which together are the places [begin, end): if that is better by the judge, or in
  // any case. True if it was done. REQUIRES: they may be; 0 < begin, end < size().
  bool DoIfBetter(size_t begin, size_t end, const PlaceRuns& runs);
  void Do(size_t begin, size_t end, const PlaceRuns& runs);

  // Paths beside which something was done since this was last asked.
  std::vector<uint32_t> TakeTouched();

  // Keeps the order as it is if it is better than the one kept last, else goes back to that. True
  // if it is kept. What it was begun with is kept at first.
  bool KeepIfBetter();

  // The other way round, if it is an open path.
  static Placement Turned(Placement placement);

 private:
  WayTotals Ask(size_t place, const Placement& from, const Placement& to);
  bool MayCut(size_t place) const;
  bool UnitEnds(size_t place) const;
  bool SameUnit(size_t begin, size_t end) const;
  bool AnyBetween(const std::vector<uint32_t>& paths, size_t begin, size_t end) const;
  WayTotals TotalsWith(size_t begin, size_t end, const PlaceRuns& runs);
  void Take(size_t begin, size_t end, size_t middle, const WayTotals& totals);

  const uint32_t first_block_;
  const LayerFreedom& freedom_;
  const PathPairs& pairs_;
  const WayEstimate& estimate_;
  const OrderMerger& judge_;

  LayerOrder order_;
  std::vector<WayTotals> ways_;  // [place] the way to there
  std::vector<size_t> place_;    // [path]
  WayTotals totals_;

  LayerOrder kept_order_;
  std::vector<WayTotals> kept_ways_;
  WayTotals kept_totals_;
  size_t changed_begin_ = 0;  // places that may differ from what is kept
  size_t changed_end_ = 0;

  std::vector<uint32_t> touched_;
  size_t asked_ = 0;
  LayerOrder run_;  // scratch: what stands at the places that are changed, and the ways to them
  std::vector<WayTotals> new_ways_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ORDER_STATE_H_
