// A lower bound that knows at which point of a contour its moves are.
//
// The trees of tree_bound.h join contours by their nearest points, whatever points their other
// moves have. Here each point has a multiplier of its own, paid for each move there, and a contour
// pays back for two moves at one of its points: the cheapest choice. What is left of the tree's
// freedom, many moves to one neighbor at points that are not chosen, costs a second kind of
// multipliers, of a point v and a near end B: no route has more moves between v and B than v is
// chosen (generalised subtours of two, Fischetti, Salazar and Toth 1997). Any multipliers give a
// bound; a deflected subgradient finds good ones.
//
// For plans whose contours have few points; the ascent looks at near pairs of ends alone, and what
// bounds is a tree over all pairs.

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

namespace traverse {

class VertexBound {
 public:
  // Whether the plan has contours with a choice of points, and few enough points in all.
  static bool Fits(const EndGraph& graph);

  // Begins with `multipliers`, [end], those of TreeBound. All arguments outlive this. REQUIRES:
  // Fits.
  VertexBound(const LayerProblem& problem, const EndGraph& graph,
              const std::vector<double>& multipliers);

  // Searches for multipliers towards `target`, the cost of a route, so many steps at most. Returns
  // a bound, 0 if the budget ended before there was one. 0.05 to 0.2 ms a step for 50 to 220
  // contours of five points.
  double Search(double target, int most_steps, Budget& budget);

 private:
  // Two ends that a move may join.
  struct Pair {
    int ends[2] = {};
    int sides[2] = {};           // among those of all junctions
    size_t multipliers[2] = {};  // where those of each one's points begin in multipliers_.near
    std::vector<double> costs;   // [i * points of ends[1] + j]
  };

  // The cheapest move between the ends of a pair: cost less multipliers, point of each end.
  struct Candidate {
    double cost = 0;
    size_t pair = 0;
    size_t points[2] = {};
    bool operator<(const Candidate& other) const {
      return cost != other.cost ? cost < other.cost : pair < other.pair;
    }
  };

  // The same of two ends that may be no pair yet.
  struct AnyCandidate {
    double cost = 0;
    int junction = 0;
    const Junction::Member* members[2] = {};
  };

  // A value for each multiplier: of points; of points and the moves from the start and to the
  // finish; of the points of pairs.
  struct Values {
    std::vector<double> point, start, finish, near;

    void Resize(size_t points, size_t of_pairs);
  };

  size_t Count(int end) const { return graph_.ends[static_cast<size_t>(end)].points.size(); }
  void AddPair(int junction, const Junction::Member& a, const Junction::Member& b);
  double AddFirstAndLast();
  double ChoosePoints();
  Candidate CheapestOf(size_t pair) const;
  AnyCandidate CheapestOfAny(int junction, const Junction::Member& a,
                             const Junction::Member& b) const;
  double EvaluateNear();
  double EvaluateAll(Budget& budget);
  void AddNearest(std::vector<AnyCandidate>& candidates);
  void Ascend(double target, int most_steps, Budget& budget);
  Values Subgradient() const;

  const EndGraph& graph_;
  const TravelCost cost_;
  std::vector<size_t> first_point_;  // [end] among all points; one more
  std::vector<int> first_side_;      // [junction] among all sides; one more
  std::vector<double> start_costs_;  // [point], infinite where a route cannot begin
  std::vector<double> finish_costs_;
  std::vector<Pair> pairs_;
  std::vector<std::vector<std::pair<int, size_t>>> pairs_of_;  // [end] other end, pair

  Values multipliers_;

  // Of the last evaluation.
  std::vector<size_t> chosen_;    // [end] among its points
  std::vector<Candidate> moves_;  // of the tree, where pairs alone were looked at
  size_t first_ = 0;  // points, among all, of the moves from the start and to the finish
  size_t last_ = 0;

  // Scratch.
  std::vector<Candidate> candidates_;
  std::vector<double> paid_back_;  // [point] by the multipliers of pairs
  DisjointSets joined_;            // the sides of all junctions
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_BOUNDS_VERTEX_BOUND_H_
