// Small path TSPs, and their best paths by trying all.

#ifndef TRAVERSE_TESTS_ENGINE_PROOF_TSP_SMALL_TSP_H_
#define TRAVERSE_TESTS_ENGINE_PROOF_TSP_SMALL_TSP_H_

#include <algorithm>
#include <vector>

#include "engine/base/rng.h"
#include "engine/model/point.h"
#include "engine/proof/min_plus.h"
#include "engine/proof/tsp/path_tsp.h"
#include "engine/proof/tsp/tsp_cuts.h"
#include "engine/proof/tsp/tsp_nodes.h"

namespace traverse {

struct SmallTsp {
  PathTsp tsp;
  std::vector<double> start;
};

// `items` with one end, with two, or with a choice of up to three ports in a square of side 100,
// some on a grid, so that there are ties.
inline SmallTsp RandomTsp(uint64_t seed, int items) {
  Rng rng(seed);
  const bool grid = rng.Below(3) == 0;
  const auto coordinate = [&] { return grid ? 10.0 * rng.Below(5) : 100 * rng.Unit(); };
  std::vector<Point> ends;
  SmallTsp instance;
  PathTsp& tsp = instance.tsp;
  for (int i = 0; i < items; ++i) {
    const int port = static_cast<int>(ends.size());
    const bool two_ends = rng.Below(3) != 0;
    const int ports = two_ends ? 2 : rng.Between(1, 3);
    for (int p = 0; p < ports; ++p) {
      tsp.item.push_back(i);
      tsp.mate.push_back(port + (two_ends ? 1 - p : p));
      ends.push_back({coordinate(), coordinate()});
    }
  }
  tsp.ports = static_cast<int>(ends.size());
  const bool has_finish = rng.Below(2) == 0;
  for (const Point& p : ends) {
    for (const Point& q : ends) tsp.cost.push_back(Distance(p, q));
    tsp.finish.push_back(has_finish ? Distance(p, {50, 0}) : 0);
    instance.start.push_back(rng.Below(5) == 0 ? kUnreached : Distance(p, {0, 0}));
  }
  instance.start[0] = 10;
  return instance;
}

inline double TspCostOf(const SmallTsp& instance, const std::vector<int>& path) {
  double cost = instance.start[static_cast<size_t>(path.front())];
  const auto exit = [&](int port) { return instance.tsp.mate[static_cast<size_t>(port)]; };
  for (size_t i = 0; i + 1 < path.size(); ++i) {
    cost += instance.tsp.Cost(exit(path[i]), path[i + 1]);
  }
  return cost + instance.tsp.finish[static_cast<size_t>(exit(path.back()))];
}

// All moves of the nodes of a problem.
inline std::vector<TspMove> AllMoves(const TspNodes& nodes) {
  std::vector<TspMove> moves;
  for (int a = 0; a < nodes.count(); ++a) {
    for (int b = a + 1; b < nodes.count(); ++b) {
      if (nodes.CanJoin(a, b)) moves.push_back({a, b});
    }
  }
  return moves;
}

// The first port of each item, in the order given.
inline std::vector<int> FirstPorts(const PathTsp& tsp) {
  std::vector<int> firsts;
  for (int p = 0; p < tsp.ports; ++p) {
    if (p == 0 || tsp.item[static_cast<size_t>(p)] != tsp.item[static_cast<size_t>(p) - 1]) {
      firsts.push_back(p);
    }
  }
  return firsts;
}

// The least cost with items from `i` on entered at any of their ports.
inline double BestTspEntries(const SmallTsp& instance, std::vector<int>& path, size_t i) {
  if (i == path.size()) return TspCostOf(instance, path);
  double best = kUnreached;
  const int first = path[i];
  const int item = instance.tsp.item[static_cast<size_t>(first)];
  for (int p = first; p < instance.tsp.ports && instance.tsp.item[static_cast<size_t>(p)] == item;
       ++p) {
    path[i] = p;
    best = std::min(best, BestTspEntries(instance, path, i + 1));
  }
  path[i] = first;
  return best;
}

// Tries all orders, directions and ports.
inline double BestTspCost(const SmallTsp& instance) {
  std::vector<int> firsts = FirstPorts(instance.tsp);
  double best = kUnreached;
  do {
    best = std::min(best, BestTspEntries(instance, firsts, 0));
  } while (std::next_permutation(firsts.begin(), firsts.end()));
  return best;
}

}  // namespace traverse

#endif  // TRAVERSE_TESTS_ENGINE_PROOF_TSP_SMALL_TSP_H_
