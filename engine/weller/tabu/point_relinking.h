// Step 3 of the framework by path relinking: a point for each contour of a fixed sequence.
//
//   from     a3 b1 c7 d2      random points of the visibility polygons
//            a3 b5 c7 d2      each step takes over the guide's point that costs least; what is
//            a1 b5 c7 d2      shorter than the guide becomes the guide
//   guide    a1 b5 c4 d9
//
// Source: thesis 2.2.8 (p. 29-30), figure 2.7, and 4.2 (p. 84): "path relinking with the points in
// the sets of VPs", the preliminary sequence being known; Gendreau and Potvin (2010).

#ifndef TRAVERSE_ENGINE_WELLER_TABU_POINT_RELINKING_H_
#define TRAVERSE_ENGINE_WELLER_TABU_POINT_RELINKING_H_

#include <vector>

#include "engine/base/budget.h"
#include "engine/base/rng.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/model/route.h"

namespace traverse {

// A layer's contours in order, each with the vertices that may be its point.
struct SequencedPoints {
  const Plan* plan = nullptr;
  std::vector<int> order;                  // indices into Plan::paths
  std::vector<std::vector<int>> vertices;  // [position], none empty
  Point start;
};

// The first guide: the vertices nearest to `near` ([position]: what represented the contour in the
// preliminary sequence). Then `rounds` paths, each from random vertices to the guide. O(rounds
// contours^2). Always a valid route of the contours, however soon the budget ends.
Route RelinkPoints(const SequencedPoints& sequence, const std::vector<Point>& near,
                   const TravelCost& cost, int rounds, Rng& rng, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_POINT_RELINKING_H_
