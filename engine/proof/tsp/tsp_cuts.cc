#include "engine/proof/tsp/tsp_cuts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>

#include "engine/base/at.h"
#include "engine/proof/programs/linear_program.h"
#include "engine/proof/tsp/max_flow.h"

namespace traverse {
namespace {

// Blossoms are looked for where there are fewer others: they are seldom the ones that matter then.
constexpr size_t kFewCuts = 25;

constexpr double kTiny = 1e-9;

// A set of whole items: x(moves within S) <= |S| - 1, for the smaller side; the depot's side counts
// the depot's edge.
TspCut ItemCut(const TspNodes& nodes, const CutSide& items) {
  TspCut cut;
  const auto inside = std::count(items.begin(), items.end(), 1);
  const bool other = 2 * inside > nodes.item_count();
  for (int v = 0; v < nodes.count(); ++v) {
    const bool in = items[At(nodes.item(v))] != 0;
    cut.side.push_back(in != other ? 1 : 0);
  }
  cut.lower = -LinearProgram::kInfinity;
  cut.upper = static_cast<double>(other ? nodes.item_count() - inside : inside) - 1;
  return cut;
}

class Separation {
 public:
  Separation(const TspNodes& nodes, const TspSolution& solution, double violation, int most,
             Budget& budget)
      : nodes_(nodes),
        solution_(solution),
        violation_(violation),
        most_(At(most)),
        budget_(budget) {}

  std::vector<TspCut> Run() {
    AddItemSets();
    AddNearSets();
    AddPortSets();
    if (cuts_.size() < kFewCuts) AddBlossoms();
    return std::move(cuts_);
  }

 private:
  void AddItemSets() {
    SupportGraph graph;
    graph.nodes = nodes_.item_count();
    for (const auto& [move, x] : solution_.moves) {
      graph.edges.push_back({nodes_.item(move.a), nodes_.item(move.b), x});
    }
    for (const CutSide& items : SmallCuts(graph, 2 - violation_)) {
      if (cuts_.size() >= most_) return;
      cuts_.push_back(ItemCut(nodes_, items));
    }
  }

  // A port and all ports of another item: no more moves between them than the port is visited.
  void AddNearSets() {
    std::map<std::pair<int, int>, double> moves;
    for (const auto& [move, x] : solution_.moves) {
      if (nodes_.item(move.a) == 0 || nodes_.item(move.b) == 0) continue;
      if (nodes_.IsChoice(move.a)) moves[{move.a, nodes_.item(move.b)}] += x;
      if (nodes_.IsChoice(move.b)) moves[{move.b, nodes_.item(move.a)}] += x;
    }
    for (const auto& [pair, x] : moves) {
      if (x < solution_.ports[At(pair.first)] + violation_) continue;
      CutSide side(At(nodes_.count()));
      side[At(pair.first)] = 1;
      for (int p = nodes_.first(pair.second); p < nodes_.first(pair.second + 1); ++p)
        side[At(p)] = 1;
      if (sides_.insert(side).second) cuts_.push_back(SetCut(side, -1));
    }
  }

  // Sets that part the ports of items with a choice: the smallest cuts between an item, or a port,
  // and the depot.
  void AddPortSets() {
    MaxFlow sending(PortGraph());
    for (int item = 1; item < nodes_.item_count(); ++item) {
      if (!nodes_.HasChoice(item) || budget_.Exhausted()) continue;
      std::vector<int> sources;
      for (int p = nodes_.first(item); p < nodes_.first(item + 1); ++p) {
        if (solution_.ports[At(p)] > violation_ / 2) sources.push_back(p);
      }
      if (sources.size() < 2 || cuts_.size() >= most_) continue;
      if (sending.Send(sources, nodes_.start(), 2) < 2 - violation_) TakeSet(sending.source_side());
      for (const int p : sources) {
        const double visited = 2 * solution_.ports[At(p)];
        if (sending.Send({p}, nodes_.start(), visited) < visited - violation_) {
          TakeSet(sending.source_side());
        }
      }
    }
  }

  // The two ends of an item are one node here: its first port; the start stands for the depot.
  SupportGraph PortGraph() const {
    SupportGraph graph;
    graph.nodes = nodes_.count();
    for (const auto& [move, x] : solution_.moves) {
      graph.edges.push_back({Merged(move.a), Merged(move.b), x});
    }
    return graph;
  }

  int Merged(int node) const { return std::min(node, nodes_.mate(node)); }

  void TakeSet(const std::vector<char>& reached) {
    CutSide side(At(nodes_.count()));
    for (int v = 0; v < nodes_.count(); ++v) side[At(v)] = reached[At(Merged(v))];
    // Ports that are not visited come with their item if the others are in: the cut is then the
    // stronger one of sets with all of an item.
    bool whole = false;
    int visited_most = -1;
    for (int item = 1; item < nodes_.item_count(); ++item) {
      double inside = 0;
      for (int p = nodes_.first(item); p < nodes_.first(item + 1); ++p) {
        if (side[At(p)] == 0) continue;
        inside += solution_.ports[At(p)];
        if (nodes_.HasChoice(item) &&
            (visited_most < 0 || solution_.ports[At(p)] > solution_.ports[At(visited_most)])) {
          visited_most = p;
        }
      }
      if (inside < 1 - kTiny) continue;
      whole = true;
      for (int p = nodes_.first(item); p < nodes_.first(item + 1); ++p) side[At(p)] = 1;
    }
    if (!sides_.insert(side).second) return;
    cuts_.push_back(SetCut(side, whole ? -1 : visited_most));
  }

  // x(moves within S) <= visited ports of S - 1, or less than y of `chosen`.
  TspCut SetCut(const CutSide& side, int chosen) const {
    TspCut cut;
    cut.side = side;
    cut.lower = -LinearProgram::kInfinity;
    cut.upper = chosen < 0 ? -1 : 0;
    cut.least_visited = chosen;
    for (int item = 1; item < nodes_.item_count(); ++item) {
      const int first = nodes_.first(item);
      const int end = nodes_.first(item + 1);
      const auto inside = std::count(side.begin() + first, side.begin() + end, 1);
      if (inside == end - first) {
        cut.upper += 1;
        continue;
      }
      for (int p = first; p < end; ++p) {
        if (side[At(p)] != 0 && p != chosen) cut.ports.emplace_back(p, -1);
      }
    }
    return cut;
  }

  // Edges between groups, and fixed ones between the ends of items.
  void AddBlossoms() {
    std::map<std::pair<int, int>, double> weights;
    for (const auto& [move, x] : solution_.moves) {
      weights[std::minmax(nodes_.group(move.a), nodes_.group(move.b))] += x;
    }
    SupportGraph graph;
    graph.nodes = nodes_.count();
    std::vector<std::pair<int, int>> pairs;
    for (const auto& [pair, weight] : weights) {
      graph.edges.push_back({pair.first, pair.second, std::min(1.0, weight)});
      pairs.push_back(pair);
    }
    for (int v = 0; v < nodes_.count(); ++v) {
      if (nodes_.mate(v) > v) graph.edges.push_back({v, nodes_.mate(v), 1});
    }
    for (CutSide side : OddCuts(graph, violation_)) {
      if (cuts_.size() >= most_) return;
      TspCut cut;
      double sum = 0;
      // All fixed edges that cross are in F: with one that is not the sum is at least 1.
      const std::vector<int> best = BestOddSet(graph, side, sum);
      for (const int edge : best) {
        if (At(edge) < pairs.size()) cut.odd.push_back(pairs[At(edge)]);
      }
      for (int v = 0; v < nodes_.count(); ++v) side[At(v)] = side[At(nodes_.group(v))];
      cut.crosses = true;
      cut.side = std::move(side);
      cut.lower = 1 - static_cast<double>(cut.odd.size());
      cut.upper = LinearProgram::kInfinity;
      cuts_.push_back(std::move(cut));
    }
  }

  const TspNodes& nodes_;
  const TspSolution& solution_;
  const double violation_;
  const size_t most_;
  Budget& budget_;
  std::set<CutSide> sides_;
  std::vector<TspCut> cuts_;
};

}  // namespace

double TspCut::Coefficient(const TspNodes& nodes, const TspMove& move) const {
  const bool a = side[At(move.a)] != 0;
  const bool b = side[At(move.b)] != 0;
  if (!crosses) return a && b ? 1 : 0;
  if (a == b) return 0;
  const std::pair<int, int> pair = std::minmax(nodes.group(move.a), nodes.group(move.b));
  return std::find(odd.begin(), odd.end(), pair) != odd.end() ? -1 : 1;
}

TspCut ByMovesOut(TspCut cut) {
  assert(!cut.crosses);
  cut.crosses = true;
  cut.ports.clear();
  if (cut.least_visited >= 0) cut.ports.emplace_back(cut.least_visited, -2);
  cut.lower = cut.least_visited < 0 ? 2 : 0;
  cut.upper = LinearProgram::kInfinity;
  return cut;
}

std::vector<TspCut> ViolatedCuts(const TspNodes& nodes, const TspSolution& solution,
                                 double violation, int most, Budget& budget) {
  return Separation(nodes, solution, violation, most, budget).Run();
}

}  // namespace traverse
