#include "engine/proof/trees/end_graph.h"

#include <cstddef>
#include <utility>

#include "engine/base/rest.h"

namespace traverse {
namespace {

// What it takes to make a short list, or to free it, as Rest counts steps.
constexpr size_t kStepsOfList = 32;

using Ends = absl::InlinedVector<int, 2>;

// Where a part of a route may begin and end.
struct Reach {
  Ends first;
  Ends last;
};

class GraphBuilder {
 public:
  GraphBuilder(const PlanTree& tree, Budget* budget, EndGraph& graph)
      : tree_(tree), graph_(graph), rest_(budget) {}

  void Build() {
    reach_.resize(static_cast<size_t>(tree_.node_count()));
    for (int index = tree_.node_count(); index-- > 0;) {
      rest_(kStepsOfList + tree_.children(index).size());
      if (tree_.path_count(index) > 0) At(index) = Visit(index);
    }
    if (reach_.empty()) return;
    graph_.first.assign(reach_[0].first.begin(), reach_[0].first.end());
    graph_.last.assign(reach_[0].last.begin(), reach_[0].last.end());
  }

 private:
  Reach& At(int node) { return reach_[static_cast<size_t>(node)]; }

  Reach Visit(int index) {
    if (tree_.is_leaf(index)) return VisitPath(tree_.node(index).path);
    return tree_.node(index).kind == PlanNode::Kind::kInOrder ? VisitInOrder(index)
                                                              : VisitAnyOrder(index);
  }

  int AddEnd(absl::Span<const Point> points, uint8_t roles, int moves) {
    graph_.ends.push_back(
        PathEnd{{points.begin(), points.end()}, BoundingBox(points), roles, moves});
    return static_cast<int>(graph_.ends.size()) - 1;
  }

  Reach VisitPath(int index) {
    const Path& path = tree_.plan().paths[static_cast<size_t>(index)];
    constexpr uint8_t kBoth = PathEnd::kEnter | PathEnd::kLeave;
    if (path.kind == Path::Kind::kContour) {
      std::vector<Point> points;
      for (const int vertex : path.allowed) points.push_back(path.points[size_t(vertex)]);
      const int end = AddEnd(path.allowed.empty() ? path.points : points, kBoth, 2);
      return {{end}, {end}};
    }
    const int first = AddEnd(absl::MakeConstSpan(path.points).first(1),
                             path.one_way ? PathEnd::kEnter : kBoth, 1);
    const int last = AddEnd(absl::MakeConstSpan(path.points).subspan(1, 1),
                            path.one_way ? PathEnd::kLeave : kBoth, 1);
    if (path.one_way) return {{first}, {last}};
    return {{first, last}, {first, last}};
  }

  Reach VisitInOrder(int index) {
    const absl::Span<const int> children = tree_.children(index);
    for (size_t c = 0; c + 1 < children.size(); ++c) {
      Junction junction;
      junction.sides = 2;
      rest_(kStepsOfList);
      for (const int end : At(children[c]).last) {
        junction.members.push_back({end, 0, PathEnd::kLeave});
      }
      for (const int end : At(children[c + 1]).first) {
        junction.members.push_back({end, 1, PathEnd::kEnter});
      }
      graph_.junctions.push_back(std::move(junction));
    }
    return {std::move(At(children.front()).first), std::move(At(children.back()).last)};
  }

  Reach VisitAnyOrder(int index) {
    const absl::Span<const int> children = tree_.children(index);
    const auto [preceded, succeeded] = Preceded(index);
    Reach reach;
    Junction junction;
    junction.sides = static_cast<int>(children.size());
    for (size_t c = 0; c < children.size(); ++c) {
      const Reach child = std::move(At(children[c]));
      rest_(child.first.size() + child.last.size());
      AddMembers(child, static_cast<int>(c), junction);
      if (!preceded[c]) Append(child.first, reach.first);
      if (!succeeded[c]) Append(child.last, reach.last);
    }
    if (junction.sides > 1) graph_.junctions.push_back(std::move(junction));
    return reach;
  }

  void AddMembers(const Reach& child, int side, Junction& junction) {
    roles_.resize(graph_.ends.size());
    for (const int end : child.first) roles_[static_cast<size_t>(end)] |= PathEnd::kEnter;
    for (const int end : child.last) roles_[static_cast<size_t>(end)] |= PathEnd::kLeave;
    for (const Ends* list : {&child.first, &child.last}) {
      for (const int end : *list) {
        uint8_t& roles = roles_[static_cast<size_t>(end)];
        if (roles == 0) continue;
        junction.members.push_back({end, side, roles});
        roles = 0;
      }
    }
  }

  static void Append(const Ends& from, Ends& to) { to.insert(to.end(), from.begin(), from.end()); }

  // Which children of an any_order have another one before them, and after them.
  std::pair<std::vector<bool>, std::vector<bool>> Preceded(int index) const {
    const PlanNode& node = tree_.node(index);
    const size_t count = tree_.children(index).size();
    std::vector<int> slot_of;
    int slot = 0;
    for (const int child : node.children)
      slot_of.push_back(tree_.path_count(child) > 0 ? slot++ : -1);
    std::pair<std::vector<bool>, std::vector<bool>> result{std::vector<bool>(count),
                                                           std::vector<bool>(count)};
    for (const auto& [first, second] : node.before) {
      const int i = slot_of[static_cast<size_t>(first)];
      const int j = slot_of[static_cast<size_t>(second)];
      if (i < 0 || j < 0) continue;
      result.second[static_cast<size_t>(i)] = true;
      result.first[static_cast<size_t>(j)] = true;
    }
    return result;
  }

  const PlanTree& tree_;
  EndGraph& graph_;
  Rest rest_;
  std::vector<Reach> reach_;    // [node]
  std::vector<uint8_t> roles_;  // [end] scratch, zero between calls
};

}  // namespace

EndGraph::EndGraph(const PlanTree& tree, Budget* budget) {
  GraphBuilder(tree, budget, *this).Build();
}

void EndGraph::Clear(Budget* budget) {
  Rest rest(budget);
  for (; !ends.empty(); ends.pop_back()) rest(kStepsOfList);
  for (; !junctions.empty(); junctions.pop_back()) rest(kStepsOfList);
}

}  // namespace traverse
