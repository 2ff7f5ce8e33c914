// What a travel move costs in a layer with walls. All strategies ask this one function, and so can
// the code that writes the moves, so that moves are made as the search counted them.
//
// A move across a wall retracts beyond a threshold of its own, lifts, and pays a price. Or it leads
// around the walls, if a detour is found that costs less. Both cost at least as much as the
// straight move without walls (TravelCost::OfLength), which is therefore a lower bound. Moves with
// a known cost do not cost less either.

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

// How a move is made.
struct WallMove {
  bool crosses = false;    // a wall
  bool retracts = false;   // with a retraction
  double length_mm = 0;    // with its bends
  double cost = 0;         // in s
  std::vector<Point> via;  // bends of the detour around walls; empty if the move is straight
};

// Remembers what it was asked, so it must not be shared between threads. Memory: 48 bytes for each
// of up to 32,768 moves, or 65,536 with detours, from the first question on.
class WallCost {
 public:
  // REQUIRES: `spec` is a time; `walls` passes CheckWalls for `plan`. O(points). Asks `budget`
  // regularly, if it is not null.
  WallCost(const LayerWalls& walls, const Plan& plan, const CostSpec& spec,
           Budget* budget = nullptr);

  // For two layers, one done right after the other: moves to and from the points of the second
  // layer are among its walls, all others among those of the first. `second_points` maps each point
  // of the second layer, as callers name it, to the point that it represents. Null: that layer has
  // no walls. The pointers must outlive this object. REQUIRES: both have the same `spec`.
  WallCost(const WallCost* first, const WallCost* second,
           const std::vector<std::pair<Point, Point>>& second_points, const CostSpec& spec);

  // What a move costs in s, and whether it retracts.
  struct Priced {
    double cost = 0;
    bool retracts = false;
  };

  // Of the move from `a` to `b`, the same in both directions. REQUIRES for Price: this is not of
  // two layers.
  double operator()(Point a, Point b) const {
    return two_layers_ ? OfTwoLayers(a, b) : Price(a, b).cost;
  }
  Priced Price(Point a, Point b) const;

  // The same, with how the move is made.
  WallMove MoveOf(Point a, Point b) const;

  const WallGrid& grid() const { return grid_; }

  // The part of a move's cost that is the price of a crossing. 0, because it is unknown, with
  // detours and for two layers.
  double PriceOf(Point a, Point b) const;

  // All questions so far, in units of about 50 ns of work. The same questions give the same
  // number, so a search may end by it. Questions to a cost of two layers count there and
  // here.
  int64_t work() const;

 private:
  struct Known {
    Point a, b;
    Priced move = {.cost = -1};  // negative: unknown
  };

  // What is special about a point.
  struct PointFacts {
    bool exposed = false;
    bool retracted = false;
    bool known = false;  // a known move begins or ends there
  };

  // The same of both ends of a move.
  struct EndFacts {
    PointFacts a, b;

    bool exposed() const { return a.exposed || b.exposed; }

    // Of what a retraction costs for which walls are the reason.
    double share_of_retraction() const {
      return 1 - (a.retracted ? 0.5 : 0) - (b.retracted ? 0.5 : 0);
    }
  };

  void NotePoints(const LayerWalls& walls, const Plan& plan, Budget* budget);
  PointFacts FactsOf(Point point) const;
  EndFacts FactsOf(Point a, Point b) const { return {FactsOf(a), FactsOf(b)}; }
  const KnownMove* FindKnown(Point a, Point b, const EndFacts& ends) const;
  WallMove Done(const KnownMove& known, Point a, Point b) const;
  WallMove Straight(Point a, Point b, const EndFacts& ends, bool crosses) const;
  Priced Compute(Point a, Point b) const;
  double OfTwoLayers(Point a, Point b) const;

  const CostSpec spec_;
  const TravelCost base_;
  const WallGrid grid_;
  const std::optional<WallDetours> detours_;
  absl::flat_hash_map<std::pair<double, double>, PointFacts> points_;  // nothing of other points
  absl::flat_hash_map<std::array<double, 4>, KnownMove> moves_;        // by their ends in order

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
