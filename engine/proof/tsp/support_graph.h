// A fractional solution as a graph, and its cuts that are too small.

#ifndef TRAVERSE_ENGINE_PROOF_TSP_SUPPORT_GRAPH_H_
#define TRAVERSE_ENGINE_PROOF_TSP_SUPPORT_GRAPH_H_

#include <vector>

namespace traverse {

// Undirected, with a weight above 0 for each edge; parallel edges add up.
struct SupportGraph {
  struct Edge {
    int a = 0;
    int b = 0;
    double weight = 0;
  };

  int nodes = 0;
  std::vector<Edge> edges;
};

// One side of a cut of a graph: side[node] is 1 for the nodes on it.
using CutSide = std::vector<char>;

// Sides, without node 0, of cuts that weigh less than `least`: all of them that one run of the
// algorithm comes across, the smallest cut of the graph among them; none if there is none.
// Components that are not connected to node 0 come alone. Nodes joined by `least` / 2 or more are
// taken as one: if each node has cuts of `least` around it, a small cut between such nodes implies
// another one that leaves them together (Padberg and Rinaldi 1990).
//
// Stoer and Wagner (1997), "A simple min-cut algorithm": O(nodes^3) after shrinking.
std::vector<CutSide> SmallCuts(const SupportGraph& graph, double least);

// Sides of odd cuts: weights in [0, 1]; for a side H let F be the odd set of its edges with the
// least sum over F of (1 - weight) + sum over the others of weight. Returns sides for which that
// sum is below 1 - `violation`: no 2-matching crosses H on exactly F (blossom inequalities; Padberg
// and Rao 1982, Letchford, Reinelt and Theis 2008). Heuristic: components of edges within some
// thresholds (Padberg and Hong 1980).
std::vector<CutSide> OddCuts(const SupportGraph& graph, double violation);

// The best F for `side`: indices into graph.edges, an odd number of those that cross. `sum` is as
// above. Empty if no edge crosses.
std::vector<int> BestOddSet(const SupportGraph& graph, const CutSide& side, double& sum);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TSP_SUPPORT_GRAPH_H_
