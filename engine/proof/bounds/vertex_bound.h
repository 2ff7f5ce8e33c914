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
// For plans whose contours have few points; the ascent looks at near moves alone, and what bounds
// is a tree over all.

#ifndef TRAVERSE_ENGINE_PROOF_BOUNDS_VERTEX_BOUND_H_
#define TRAVERSE_ENGINE_PROOF_BOUNDS_VERTEX_BOUND_H_

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/base/budget.h"
#include "engine/base/disjoint_sets.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/layer_problem.h"
#include "engine/proof/bounds/end_graph.h"
#include "engine/proof/bounds/near_moves.h"
#include "engine/proof/bounds/subtour_sets.h"

namespace traverse {

class VertexBound {
 public:
  // Whether the plan has contours with a choice of points, and few enough points in all.
  static bool Fits(const EndGraph& graph);

  // Begins with `multipliers`, [end], those of TreeBound. All arguments outlive this. REQUIRES:
  // Fits.
  VertexBound(const LayerProblem& problem, const EndGraph& graph,
              const std::vector<double>& multipliers);

  // Searches for multipliers towards `target`, the cost of a route, for so many rounds at most.
  // Returns a bound, 0 if the budget ended before there was one; more rounds never give a lower
  // one. A round takes 15 to 150 ms for 40 to 220 contours of five points.
  double Search(double target, int most_rounds, Budget& budget);

 private:
  // The cheapest move between the sides of a group: cost less multipliers.
  struct Candidate {
    double cost = 0;
    size_t group = 0;
    bool operator<(const Candidate& other) const {
      return cost != other.cost ? cost < other.cost : group < other.group;
    }
  };

  // The same of two ends, any of their points.
  struct AnyCandidate {
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

  double AddFirstAndLast();
  double ChoosePoints();
  double Least(const NearMoves::Group& group) const;
  size_t CheapestOf(const NearMoves::Group& group) const;
  AnyCandidate CheapestOfAny(int junction, const Junction::Member& a,
                             const Junction::Member& b) const;
  bool ListAll(std::vector<AnyCandidate>& all, Budget& budget);
  double EvaluateNear();
  double EvaluateAll(Budget& budget);
  void AddNearest(const std::vector<AnyCandidate>& candidates, Budget& budget);
  double Rounding() const;
  void Average();
  void Cut(Budget& budget);
  double SquareOfDirection() const;
  void Step(double length);
  void Ascend(double target, Budget& budget);

  const EndGraph& graph_;
  const TravelCost cost_;
  NearMoves moves_;
  SubtourSets sets_;
  std::vector<double> start_costs_;  // [point], infinite where a route cannot begin
  std::vector<double> finish_costs_;
  std::vector<double> penalties_;  // [move] by sets_
  std::vector<double> paid_back_;  // [point] by sets_

  Values multipliers_;
  Values best_multipliers_;
  Values direction_;  // what average_ violates
  AverageSolution average_;
  double factor_ = 1;  // of steps
  int steps_ = 0;

  // Of the last evaluation.
  std::vector<int> chosen_;      // [end] point
  std::vector<Candidate> tree_;  // where near moves alone were looked at
  std::vector<size_t> tree_moves_;
  int first_ = 0;  // points of the moves from the start and to the finish
  int last_ = 0;

  // Scratch.
  std::vector<Candidate> candidates_;
  DisjointSets joined_;  // the sides of all junctions
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_BOUNDS_VERTEX_BOUND_H_
