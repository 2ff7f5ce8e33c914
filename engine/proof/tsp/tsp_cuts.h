// The inequalities that a fractional solution of a path TSP (path_tsp.h) violates.

#ifndef TRAVERSE_ENGINE_PROOF_TSP_TSP_CUTS_H_
#define TRAVERSE_ENGINE_PROOF_TSP_TSP_CUTS_H_

#include <utility>
#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/tsp/support_graph.h"
#include "engine/proof/tsp/tsp_nodes.h"

namespace traverse {

// A move between two nodes, a < b.
struct TspMove {
  int a = 0;
  int b = 0;
};

// lower <= sum of x over moves, each with its coefficient, + sum over ports <= upper.
struct TspCut {
  bool crosses = false;                       // counts moves out of `side`, else those within it
  CutSide side;                               // [node] S or H
  std::vector<std::pair<int, int>> odd;       // of a blossom, groups of F's moves: first < second
  std::vector<std::pair<int, double>> ports;  // with a choice, and their coefficients
  double lower = 0;
  double upper = 0;
  int least_visited = -1;  // the p of a subtour, or -1 if S has all of an item

  double Coefficient(const TspNodes& nodes, const TspMove& move) const;
};

// The same subtour by the moves out of S, which are fewer if S is large:
//   x(moves out of S) >= 2 or 2 y_p
// Equal where the moves of each node add up. REQUIRES: `cut` is a subtour by the moves within S.
TspCut ByMovesOut(TspCut cut);

// The moves and ports whose values are not 0.
struct TspSolution {
  std::vector<std::pair<TspMove, double>> moves;
  std::vector<double> ports;  // [port] 1 without a choice
};

// About `most` cuts that are violated by more than `violation`; fewer if the budget ends.
std::vector<TspCut> ViolatedCuts(const TspNodes& nodes, const TspSolution& solution,
                                 double violation, int most, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TSP_TSP_CUTS_H_
