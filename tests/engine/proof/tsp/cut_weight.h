// The weight of a cut, added up edge by edge.

#ifndef TRAVERSE_TESTS_ENGINE_PROOF_TSP_CUT_WEIGHT_H_
#define TRAVERSE_TESTS_ENGINE_PROOF_TSP_CUT_WEIGHT_H_

#include "engine/proof/tsp/support_graph.h"

namespace traverse::testing {

inline double CutWeight(const SupportGraph& graph, const CutSide& side) {
  double sum = 0;
  for (const SupportGraph::Edge& edge : graph.edges) {
    if (side[static_cast<size_t>(edge.a)] != side[static_cast<size_t>(edge.b)]) sum += edge.weight;
  }
  return sum;
}

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_ENGINE_PROOF_TSP_CUT_WEIGHT_H_
