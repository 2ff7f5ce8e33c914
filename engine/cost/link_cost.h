// The cost of a link from one path to another: departure + move + arrival, which is not the same in
// both directions. The seconds of departure and arrival depend on whether the move retracts.

#ifndef TRAVERSE_ENGINE_COST_LINK_COST_H_
#define TRAVERSE_ENGINE_COST_LINK_COST_H_

#include <optional>

#include "engine/cost/travel_cost.h"
#include "engine/cost/wall_cost.h"
#include "engine/model/layer_problem.h"
#include "engine/model/links.h"
#include "engine/model/point.h"
#include "engine/model/route.h"
#include "engine/model/walls.h"

namespace traverse {

class LinkCost {
 public:
  // Where the head is when a move begins, and what it took to get there.
  struct Left {
    Point at;
    LinkSeconds seconds;
  };

  // Where a move ends, and what it takes to arrive there.
  struct Reached {
    Point at;
    LinkSeconds seconds;
  };

  // `problem` may have no links; what it refers to must outlive this object.
  // REQUIRES: LinksFit(*problem.links), problem.walls_unit == 1.
  explicit LinkCost(const LayerProblem& problem) : problem_(problem), travel_(problem) {}

  // Before the first path, and after that of `visit`.
  Left Before() const { return {problem_.start, problem_.before.seconds}; }
  Left After(const Visit& visit) const;

  // The begin of the path of `visit`.
  Reached BeginOf(const Visit& visit) const;

  // The move from there to the path of `visit`.
  WallMove MoveTo(const Left& left, const Visit& visit) const;

  // What the whole link costs, in mm or s; and what it does at least, as if there were no walls.
  double To(const Left& left, const Reached& reached) const;
  double AtLeastTo(const Left& left, const Reached& reached) const;
  double To(const Left& left, const Visit& visit) const { return To(left, BeginOf(visit)); }
  double AtLeastTo(const Left& left, const Visit& visit) const {
    return AtLeastTo(left, BeginOf(visit));
  }

  // The move to the problem's finish. The departure before it counts nowhere, as the move itself.
  double ToFinish(const Left& left) const {
    return problem_.finish ? travel_(left.at, *problem_.finish) : 0;
  }

 private:
  double SecondsOf(const Left& left, const Reached& reached, bool retracts) const;

  const LayerProblem problem_;
  const TravelCost travel_;
};

// The cost with which searches that know none but the same both ways come closest to that of
// `links`: a retraction costs what it does on an average.
CostSpec SymmetricCost(CostSpec spec, const LayerLinks& links);

// The walls of such a search, in which a retraction costs `retraction_seconds` more: known moves
// that retract state what they take without what departure and arrival take longer for it.
LayerWalls SymmetricWalls(LayerWalls walls, double retraction_seconds);

// A problem without links and walls, which bounds one with links: no route of that costs less than
// the best of this and `seconds` (which may be negative; mm, if the cost is a length).
struct LeastLinks {
  CostSpec cost;
  double seconds = 0;
  bool moved = false;  // some move begins elsewhere than at an exit
};
LeastLinks LeastOf(const LayerProblem& problem);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_LINK_COST_H_
