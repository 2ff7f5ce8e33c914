// Smallest cuts between two nodes of a small undirected graph.

#ifndef TRAVERSE_ENGINE_PROOF_TSP_MAX_FLOW_H_
#define TRAVERSE_ENGINE_PROOF_TSP_MAX_FLOW_H_

#include <vector>

#include "engine/proof/tsp/support_graph.h"

namespace traverse {

// Prepared once and used for many pairs. Ford and Fulkerson (1956) with shortest augmenting paths
// (Edmonds and Karp 1972): graphs of fractional solutions have few edges, and flows of at most 2.
class MaxFlow {
 public:
  // Weights are capacities in both directions.
  explicit MaxFlow(const SupportGraph& graph);

  // Sends as much as possible from `sources` to `sink`, up to `most`. Returns the amount sent; if
  // that is less than `most`, source_side() is one side of the smallest cut. REQUIRES: `sink` is no
  // source, and there is a source.
  double Send(const std::vector<int>& sources, int sink, double most);

  // [node] 1 for nodes that the last Send could still reach: the smallest side of a smallest cut.
  const std::vector<char>& source_side() const { return reached_; }

 private:
  struct Arc {
    int to = 0;
    int back = 0;  // index of the arc in the other direction
    double capacity = 0;
  };

  bool Reach(const std::vector<int>& sources, int sink);

  std::vector<Arc> arcs_;
  std::vector<int> first_;       // [node] where its arcs begin; one more
  std::vector<double> left_;     // [arc]
  std::vector<char> reached_;    // [node]
  std::vector<int> reached_by_;  // [node] arc, -1 for sources
  std::vector<int> queue_;       // scratch
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TSP_MAX_FLOW_H_
