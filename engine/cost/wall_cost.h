// What a travel move costs in a layer with walls: the one function that strategies ask, and that
// whoever carries the moves out can ask, so that what was found is what is done.
//
// A move across a wall is retracted beyond a threshold of its own, is lifted, and pays a price; or
// it is led around the walls, if there is a way that costs less. Either costs no less than the
// straight move does without walls (TravelCost::OfLength), which therefore bounds it from below;
// nor does a move of which it is known what it costs.

#ifndef TRAVERSE_ENGINE_COST_WALL_COST_H_
#define TRAVERSE_ENGINE_COST_WALL_COST_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "engine/cost/travel_cost.h"
#include "engine/geometry/wall_detour.h"
#include "engine/geometry/wall_grid.h"
#include "engine/model/cost_spec.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/model/walls.h"

namespace traverse {

// How a move is done.
struct WallMove {
  bool crosses = false;    // a wall
  bool retracts = false;   // filament is pulled back for it
  double length_mm = 0;    // with the bends
  double cost = 0;         // in s
  std::vector<Point> via;  // bends of the way around walls; empty: it is straight
};

// Remembers what it was asked, so not for several threads at once. Memory: 40 bytes for each of up
// to 32,768 moves, or 65,536 where ways are led around walls, from the first question on.
class WallCost {
 public:
  // REQUIRES: `spec` is a time; `walls` passes CheckWalls for `plan`. O(points) and sorting those
  // of exposed and retracted paths; asks `budget`, if there is one, meanwhile.
  WallCost(const LayerWalls& walls, const Plan& plan, const CostSpec& spec,
           Budget* budget = nullptr);

  // Of two layers, one done right after the other: moves to and from the points of the second are
  // among its walls, all others among those of the first. `second_points`: for each point of the
  // second layer, as it is asked for, what it stands for. Null: that layer has no walls; what is
  // pointed to outlives this. REQUIRES: both have the same `spec`.
  WallCost(const WallCost* first, const WallCost* second,
           const std::vector<std::pair<Point, Point>>& second_points, const CostSpec& spec);

  // The cost in s of the move from `a` to `b`, the same there and back.
  double operator()(Point a, Point b) const;

  // The same, and how it comes about.
  WallMove MoveOf(Point a, Point b) const;

  const WallGrid& grid() const { return grid_; }

  // What of the cost of a move is the price of a crossing. Where ways are led around walls, and of
  // two layers, nobody knows: 0.
  double PriceOf(Point a, Point b) const;

  // What has been asked so far, counted in what takes some 50 ns: the same for the same questions,
  // so that a search may end by it. What the two layers were asked through a cost of both counts
  // there, and here.
  int64_t work() const;

 private:
  struct Known {
    Point a, b;
    double cost = -1;  // negative: nothing is known
  };

  bool IsExposed(Point a, Point b) const;
  double ShareOfRetraction(Point a, Point b) const;
  const KnownMove* FindKnown(Point a, Point b) const;
  WallMove Done(const KnownMove& known, Point a, Point b) const;
  WallMove Straight(Point a, Point b, bool crosses) const;
  double Compute(Point a, Point b) const;
  double OfTwoLayers(Point a, Point b) const;

  const CostSpec spec_;
  const TravelCost base_;
  const WallGrid grid_;
  const std::optional<WallDetours> detours_;
  std::vector<Point> exposed_;                                   // sorted
  std::vector<Point> retracted_;                                 // the same
  absl::flat_hash_map<std::array<double, 4>, KnownMove> moves_;  // by their ends in order

  const bool two_layers_ = false;
  const WallCost* first_ = nullptr;
  const WallCost* second_ = nullptr;
  absl::flat_hash_map<std::pair<double, double>, Point> second_points_;

  const size_t places_;
  mutable std::vector<Known> known_;  // by a hash of the move; empty at first
  mutable int64_t work_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_WALL_COST_H_
