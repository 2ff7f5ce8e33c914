// Two moves that would take the place of others, asked for only as far as that matters: among walls
// the cost of a move is worth a search, and what it costs at least is known at once.

#ifndef TRAVERSE_ENGINE_COST_TWO_MOVES_H_
#define TRAVERSE_ENGINE_COST_TWO_MOVES_H_

#include <cmath>
#include <limits>
#include <optional>

#include "engine/cost/travel_cost.h"
#include "engine/model/point.h"

namespace traverse {

// The moves from `a` to `b` and from `c` to `d`; the second one is none without `d`.
struct TwoMoves {
  Point a, b, c;
  std::optional<Point> d;

  // What they cost at least: as if there were no walls.
  double Least(const TravelCost& cost) const {
    return cost.Base(a, b) + (d ? cost.Base(c, *d) : 0);
  }

  // What they cost, if that is at most `most`; otherwise some bound that is above `most` too.
  // `on_ask()` is called before walls are asked for.
  template <typename OnAsk>
  double CostWithin(double most, const TravelCost& cost, OnAsk on_ask) const {
    if (!cost.has_walls()) return Least(cost);
    // Rounding may take a bound above the cost itself.
    constexpr double kSlackOfBounds = 1e-6;
    const double beyond = most + kSlackOfBounds * (1 + std::abs(most));
    const double second = d ? cost.Base(c, *d) : 0;
    const double least = cost.Base(a, b) + second;
    if (least > beyond) return least;
    on_ask();
    const double first = cost(a, b);
    if (!d || first + second > beyond) return first + second;
    return first + cost(c, *d);
  }

  double CostWithin(double most, const TravelCost& cost) const {
    return CostWithin(most, cost, [] {});
  }
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_TWO_MOVES_H_
