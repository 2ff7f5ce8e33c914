// A lower bound from trees, for every plan and both costs.
//
// Every route joins the sides of each junction (end_graph.h) to a tree, begins at the start and
// ends at the finish, and has one move at each end of an open path, two at a contour. Without the
// latter the least such trees are minimum spanning trees; a multiplier for each end, paid for each
// move there and paid back as often as a route has moves there, makes trees more like routes and
// changes no route's cost (Held and Karp 1970). Between two contours the distance of their nearest
// points counts, whatever vertices the other moves have: where large contours are many the bound is
// weak.
//
// Two evaluations: over all pairs of ends (Prim; linear memory, pairs of far contours bounded by
// their boxes), which is what bounds, and over a few near ones (Kruskal), which finds multipliers.

#ifndef TRAVERSE_ENGINE_PROOF_TREES_TREE_BOUND_H_
#define TRAVERSE_ENGINE_PROOF_TREES_TREE_BOUND_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "engine/base/budget.h"
#include "engine/base/disjoint_sets.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/layer_problem.h"
#include "engine/proof/trees/end_graph.h"

namespace traverse {

class TreeBound {
 public:
  // A pair of ends in `junction`, members of `sides`, and the cost of the move between them.
  struct Pair {
    int junction = 0;
    int ends[2] = {};
    int sides[2] = {};
    double cost = 0;
  };

  // `problem` has a path; its plan outlives this. If the budget ends here, ascents gain nothing.
  TreeBound(const LayerProblem& problem, Budget& budget);

  // Ends this bound: frees what takes long to free and gives others their turn meanwhile.
  // Afterwards only the bound and its multipliers may be asked for.
  void Clear(Budget& budget);

  // Evaluates all pairs at the current multipliers and remembers the highest bound so far. False if
  // the budget ended it. O(ends^2) time.
  bool Evaluate(Budget& budget);

  // Takes at most `most_steps` steps to better multipliers, towards `target`, the cost of a route.
  void Ascend(double target, int most_steps, Budget& budget);

  // No route costs less. 0 before the first evaluation.
  double lower_bound() const { return lower_bound_; }

  const EndGraph& graph() const { return graph_; }

  // Pairs near each other, and all that trees had so far.
  const std::vector<Pair>& pairs() const { return pairs_; }

  // The multipliers of the bound, [end], in the same order for equal plans.
  const std::vector<double>& multipliers() const { return best_multipliers_; }
  void SetMultipliers(const std::vector<double>& multipliers) { multipliers_ = multipliers; }

 private:
  // The sides of one junction that are not joined yet, in arrays for the inner loop.
  struct Pool;

  double Cost(int a, int b, Budget& budget) const;
  double CostTo(Point point, int end) const;
  void FindNearPairs(Budget& budget);
  void AddPair(int junction, const Junction::Member& a, const Junction::Member& b, Budget& budget);
  double JoinAll(int junction, Budget& budget);
  void Reach(const Junction::Member& from, Pool& pool) const;
  void ReachByBoxes(const Junction::Member& from, Pool& pool) const;
  double AddFirstAndLast();
  double EvaluateNear(Budget& budget);
  std::vector<double> Subgradient() const;

  EndGraph graph_;
  const TravelCost cost_;
  std::vector<double> start_costs_;   // [graph_.first] from the start
  std::vector<double> finish_costs_;  // [graph_.last] to the finish, 0 if there is none
  std::vector<int> first_side_;       // [junction] its first side among all; one more

  std::vector<double> multipliers_;       // [end]
  std::vector<double> best_multipliers_;  // [end] of the bound
  double lower_bound_ = 0;

  std::vector<Pair> pairs_;  // of ends near each other
  std::vector<absl::InlinedVector<std::pair<int, double>, 4>>
      near_;  // [end] the other ends and costs of pairs_

  // Scratch.
  std::vector<int> moves_;                      // [end] of the last tree
  std::vector<std::pair<double, int>> sorted_;  // costs less multipliers, pairs
  DisjointSets joined_;                         // the sides of all junctions
  std::vector<int> member_of_;                  // [end] in the current junction, else -1
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TREES_TREE_BOUND_H_
