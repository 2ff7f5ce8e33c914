// A lower bound that knows at which point of a contour its moves are.
//
// The trees of tree_bound.h join contours by their nearest points, whatever points their other
// moves have. Here each point has a multiplier of its own, paid for each move there, and a contour
// pays back for two moves at one of its points: the cheapest choice. What is left of the tree's
// freedom, moves that go around among points that are not chosen, costs multipliers of a second
// kind: generalised subtours (subtour_sets.h), looked for in the average of the last solutions as
// branch and cut does in those of a linear programme (relax and cut; Lucena 2005). Any multipliers
// give a bound; a deflected subgradient, whose direction is what that average violates, finds good
// ones.
//
// Of a contour of many points, neighboring ones are taken together as one place, and split where
// solutions visit it (places.h). The ascent looks at near moves alone; what bounds is a tree over
// all.

#ifndef TRAVERSE_ENGINE_PROOF_VERTICES_VERTEX_BOUND_H_
#define TRAVERSE_ENGINE_PROOF_VERTICES_VERTEX_BOUND_H_

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/base/disjoint_sets.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/layer_problem.h"
#include "engine/model/point.h"
#include "engine/proof/trees/end_graph.h"
#include "engine/proof/trees/tree_bound.h"
#include "engine/proof/vertices/near_moves.h"
#include "engine/proof/vertices/near_sets.h"
#include "engine/proof/vertices/subtour_sets.h"

namespace traverse {

class VertexBound {
 public:
  // Whether the plan has contours with a choice of points, and few enough ends.
  static bool Fits(const EndGraph& graph);

  // Begins with the multipliers and the pairs of `tree`, which outlives this. REQUIRES: Fits.
  VertexBound(const LayerProblem& problem, const TreeBound& tree);
  VertexBound(const VertexBound&) = delete;
  VertexBound& operator=(const VertexBound&) = delete;

  // How far a search goes: so many rounds, and so much work, in distances and sums of costs, of
  // some nanoseconds each; in rounds that begin far below the target, up to `work_while_far`.
  struct Limits {
    int rounds = 0;
    double work = std::numeric_limits<double>::infinity();
    double work_while_far = 0;
  };

  // Searches for multipliers towards `target`, the cost of a route. Returns a bound, 0 if the
  // budget or the work ended before there was one; more rounds never give a lower one. A round
  // takes 6 to 60 ms for 40 to 320 paths.
  double Search(double target, const Limits& limits, Budget& budget);

  // What was done so far. Goes beyond the limit by at most as much as an evaluation takes.
  double work() const { return work_ + kWorkOfDistance * moves_.places().distances(); }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  static constexpr double kWorkOfDistance = 0.25;

  // The cheapest move between the sides of a group: cost less multipliers.
  struct Candidate {
    double cost = 0;
    size_t group = 0;
    bool operator<(const Candidate& other) const {
      return cost != other.cost ? cost < other.cost : group < other.group;
    }
  };

  // Two ends whose moves are not known, and the cheapest of them: cost less multipliers.
  struct Extra {
    double cost = 0;
    int junction = 0;
    const Junction::Member* members[2] = {};
  };

  // A value for each multiplier of points, and of points and the moves from the start and to the
  // finish.
  struct Values {
    std::vector<double> point, start, finish;
    explicit Values(size_t points) : point(points), start(points), finish(points) {}
  };

  void FindCostsOfFirstAndLast();
  void AddPairs(const TreeBound& tree);

  // In vertex_trees.cc.
  double AddFirstAndLast();
  double ChoosePoints();
  double Weigh();
  double Least(size_t group) const;
  size_t CheapestOf(size_t group) const;
  double LeastOfUnknown(const Junction::Member& a, const Junction::Member& b, double most) const;
  double JoinKnown(const std::vector<Extra>& extras);
  void Keep(std::vector<Extra>& extras) const;
  bool FindExtras(std::vector<Extra>& extras, Budget& budget);
  double EvaluateNear();
  double EvaluateAll(Budget& budget);

  void Refine();
  void Average();
  void Cut(Budget& budget);
  double SquareOfDirection() const;
  void Step(double length);
  void Ascend(double target, Budget& budget);

  double WorkOfStep() const;

  // Whether the search has done what it may, if it does so much more.
  bool Ended(Budget& budget, double more) {
    return work() + more > most_work_ || budget.ExhaustedNow();
  }

  const EndGraph& graph_;
  size_t points_of_plan_ = 0;  // as often as ends have them
  const TravelCost cost_;
  Point start_;
  std::optional<Point> finish_;
  NearMoves moves_;
  NearSets near_;
  SubtourSets sets_;
  std::vector<double> start_costs_;  // [point], infinite where a route cannot begin
  std::vector<double> finish_costs_;
  Penalties penalties_;            // by all sets
  std::vector<double> paid_back_;  // [point] by all sets

  Values multipliers_;
  Values best_multipliers_;
  Values direction_;  // what average_ violates
  AverageSolution average_;
  double factor_ = 1;  // of steps
  int steps_ = 0;
  int rounds_ = 0;
  double most_work_ = 0;           // for now
  double work_ = 0;                // so far, but for distances
  double work_of_evaluation_ = 0;  // of the last one over all moves
  double mean_move_ = 0;           // of a route that costs as much as the target

  // Of the last evaluation.
  std::vector<int> chosen_;                // [end] point
  std::vector<Candidate> tree_;            // where near moves alone were looked at
  std::vector<SubtourSets::Taken> taken_;  // its moves
  int first_ = 0;                          // points of the moves from the start and to the finish
  int last_ = 0;

  // Scratch.
  std::vector<Candidate> candidates_;
  DisjointSets joined_;       // the sides of all junctions
  std::vector<double> most_;  // [junction] cost of a move that a tree over known ones has
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_VERTICES_VERTEX_BOUND_H_
