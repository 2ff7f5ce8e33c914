#include "engine/souza/descent.h"

#include <cstddef>
#include <vector>

#include "engine/souza/block_line.h"
#include "engine/souza/point_release.h"
#include "engine/souza/two_opt.h"

namespace traverse {
namespace {

// 2-opt on the nodes of a search route; keeps its memory from one node to the next.
class NodeTwoOpt {
 public:
  explicit NodeTwoOpt(SearchRoute& route) : route_(route), line_(route.layer().cost) {}

  // Processes every pending node once. Returns the change of cost.
  double Sweep(Budget& budget) {
    const PlanTree& tree = route_.layer().tree;
    double change = 0;
    for (int node = 0; node < tree.node_count(); ++node) {
      if (tree.node(node).kind != PlanNode::Kind::kAnyOrder || tree.children(node).empty()) {
        continue;
      }
      if (budget.Exhausted()) break;
      if (route_.TakePendingNode(node)) change += Improve(node, budget);
    }
    return change;
  }

 private:
  double Improve(int node, Budget& budget) {
    LoadBlocks(node);
    const int last = route_.begin(node) + route_.layer().tree.path_count(node) - 1;
    line_.Load(route_.from(route_.begin(node)), route_.to(last), blocks_,
               route_.layer().tree.precedence(node));
    const double change = TwoOpt(line_, budget);
    if (change < 0) {
      route_.Arrange(node, line_.slots(), line_.reversed());
      // What lies below has new neighbors now, but this order was just found to be the best.
      route_.TakePendingNode(node);
    }
    return change;
  }

  void LoadBlocks(int node) {
    const PlanTree& tree = route_.layer().tree;
    const EntryTable& table = route_.layer().table;
    const absl::Span<const int> children = tree.children(node);
    blocks_.clear();
    for (const int slot : route_.order(node)) {
      const int child = children[static_cast<size_t>(slot)];
      const int first = route_.begin(child);
      const int last = first + tree.path_count(child) - 1;
      blocks_.push_back(Block{table.enter(route_.entry(first)), table.exit(route_.entry(last)),
                              slot, tree.reversible(child)});
    }
  }

  SearchRoute& route_;
  BlockLine line_;
  std::vector<Block> blocks_;
};

}  // namespace

double Descend(SearchRoute& route, const DescentOptions& options, Budget& budget) {
  const Released released = options.point_release ? Released::kAll : Released::kOpenPaths;
  NodeTwoOpt two_opt(route);
  double change = 0;
  double gain = -1;
  while (gain < 0 && !budget.Exhausted()) {
    gain = two_opt.Sweep(budget);
    gain += ReleasePoints(route, released, budget);
    change += gain;
  }
  return change;
}

Route Improve(const LayerView& layer, const Route& route, const DescentOptions& options,
              Budget& budget) {
  SearchRoute search(layer, route, &budget);
  Descend(search, options, budget);
  return search.ToRoute();
}

}  // namespace traverse
