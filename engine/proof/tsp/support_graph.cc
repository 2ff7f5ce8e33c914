#include "engine/proof/tsp/support_graph.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include "engine/base/disjoint_sets.h"

namespace traverse {
namespace {

// The sets as nodes, with the weights between them summed up.
struct Shrunk {
  Shrunk(const SupportGraph& graph, DisjointSets& sets) : group(sets.Numbered()) {
    if (!group.empty()) count = *std::max_element(group.begin(), group.end()) + 1;
    weight.assign(static_cast<size_t>(count) * static_cast<size_t>(count), 0);
    for (const SupportGraph::Edge& edge : graph.edges) {
      const int a = group[static_cast<size_t>(edge.a)];
      const int b = group[static_cast<size_t>(edge.b)];
      if (a == b) continue;
      at(a, b) += edge.weight;
      at(b, a) += edge.weight;
    }
  }
  double& at(int a, int b) {
    return weight[static_cast<size_t>(a) * static_cast<size_t>(count) + static_cast<size_t>(b)];
  }

  int count = 0;
  std::vector<int> group;      // [node]; that of node 0 is 0
  std::vector<double> weight;  // [a * count + b]
};

// The nodes whose groups are in `groups`, or the others if node 0 is among them.
CutSide SideOf(const Shrunk& shrunk, const std::vector<char>& groups) {
  CutSide side;
  const char inside = groups[0] != 0 ? 0 : 1;
  for (const int group : shrunk.group) {
    side.push_back(groups[static_cast<size_t>(group)] == inside ? 1 : 0);
  }
  return side;
}

std::vector<CutSide> LooseComponents(const SupportGraph& graph) {
  DisjointSets sets(graph.nodes);
  for (const SupportGraph::Edge& edge : graph.edges) sets.Join(edge.a, edge.b);
  const Shrunk components(graph, sets);
  std::vector<CutSide> sides;
  for (int c = 1; c < components.count; ++c) {
    std::vector<char> chosen(static_cast<size_t>(components.count));
    chosen[static_cast<size_t>(c)] = 1;
    sides.push_back(SideOf(components, chosen));
  }
  return sides;
}

// Stoer-Wagner: each phase orders the groups by how strongly they are tied to those before; the
// last one's cut is the smallest between the last two, which are then merged.
class MinimumCut {
 public:
  MinimumCut(Shrunk& graph, double least) : graph_(graph), least_(least) {
    for (int g = 0; g < graph.count; ++g) {
      left_.push_back(g);
      members_.emplace_back(static_cast<size_t>(graph.count));
      members_.back()[static_cast<size_t>(g)] = 1;
    }
  }

  std::vector<CutSide> Run() {
    std::set<CutSide> sides;
    while (left_.size() > 1) Phase(sides);
    return {sides.begin(), sides.end()};
  }

 private:
  void Phase(std::set<CutSide>& sides) {
    std::vector<double> tie(static_cast<size_t>(graph_.count), 0);
    std::vector<int> rest = left_;
    int last = -1;
    int before = -1;
    while (!rest.empty()) {
      size_t strongest = 0;
      for (size_t i = 1; i < rest.size(); ++i) {
        if (Tie(tie, rest[i]) > Tie(tie, rest[strongest])) strongest = i;
      }
      before = last;
      last = rest[strongest];
      rest[strongest] = rest.back();
      rest.pop_back();
      for (const int other : rest) tie[static_cast<size_t>(other)] += graph_.at(last, other);
    }
    if (Tie(tie, last) < least_) {
      sides.insert(SideOf(graph_, members_[static_cast<size_t>(last)]));
    }
    MergeInto(before, last);
  }

  static double Tie(const std::vector<double>& tie, int group) {
    return tie[static_cast<size_t>(group)];
  }

  void MergeInto(int kept, int merged) {
    for (const int other : left_) {
      graph_.at(kept, other) += graph_.at(merged, other);
      graph_.at(other, kept) = graph_.at(kept, other);
    }
    std::vector<char>& all = members_[static_cast<size_t>(kept)];
    const std::vector<char>& more = members_[static_cast<size_t>(merged)];
    for (size_t g = 0; g < all.size(); ++g) all[g] = all[g] != 0 || more[g] != 0 ? 1 : 0;
    left_.erase(std::find(left_.begin(), left_.end(), merged));
  }

  Shrunk& graph_;
  const double least_;
  std::vector<int> left_;
  std::vector<std::vector<char>> members_;  // [group left][group]
};

}  // namespace

std::vector<CutSide> SmallCuts(const SupportGraph& graph, double least) {
  std::vector<CutSide> loose = LooseComponents(graph);
  if (!loose.empty()) return loose;
  DisjointSets sets(graph.nodes);
  for (const SupportGraph::Edge& edge : graph.edges) {
    if (edge.weight >= least / 2) sets.Join(edge.a, edge.b);
  }
  Shrunk shrunk(graph, sets);
  return MinimumCut(shrunk, least).Run();
}

std::vector<int> BestOddSet(const SupportGraph& graph, const CutSide& side, double& sum) {
  std::vector<int> odd;
  sum = 0;
  int flip = -1;  // the edge whose change costs least
  double flip_cost = 2;
  for (size_t e = 0; e < graph.edges.size(); ++e) {
    const SupportGraph::Edge& edge = graph.edges[e];
    if (side[static_cast<size_t>(edge.a)] == side[static_cast<size_t>(edge.b)]) continue;
    if (edge.weight > 0.5) odd.push_back(static_cast<int>(e));
    sum += std::min(edge.weight, 1 - edge.weight);
    const double cost = std::abs(1 - 2 * edge.weight);
    if (cost < flip_cost) {
      flip_cost = cost;
      flip = static_cast<int>(e);
    }
  }
  if (flip < 0 || odd.size() % 2 == 1) return odd;
  sum += flip_cost;
  const auto found = std::find(odd.begin(), odd.end(), flip);
  if (found != odd.end()) {
    odd.erase(found);
  } else {
    odd.push_back(flip);
  }
  return odd;
}

std::vector<CutSide> OddCuts(const SupportGraph& graph, double violation) {
  constexpr double kThresholds[] = {0.001, 0.1, 0.2, 0.3, 0.4};
  std::set<CutSide> sides;
  for (const double threshold : kThresholds) {
    DisjointSets sets(graph.nodes);
    for (const SupportGraph::Edge& edge : graph.edges) {
      if (edge.weight > threshold && edge.weight < 1 - threshold) sets.Join(edge.a, edge.b);
    }
    const Shrunk components(graph, sets);
    for (int c = 0; c < components.count; ++c) {
      std::vector<char> chosen(static_cast<size_t>(components.count));
      chosen[static_cast<size_t>(c)] = 1;
      const CutSide side = SideOf(components, chosen);
      double sum = 0;
      const std::vector<int> odd = BestOddSet(graph, side, sum);
      if (odd.size() >= 3 && sum < 1 - violation) sides.insert(side);
    }
  }
  return {sides.begin(), sides.end()};
}

}  // namespace traverse
