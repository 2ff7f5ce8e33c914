#include "engine/model/route_fault.h"

#include <algorithm>
#include <cassert>
#include <climits>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/base/rest.h"
#include "engine/model/tree/plan_tree.h"

namespace traverse {
namespace {

bool MayEnter(const Path& path, int entry) {
  if (entry < 0 || entry >= static_cast<int>(path.points.size())) return false;
  if (path.kind == Path::Kind::kOpen) return entry == 0 || !path.one_way;
  return path.allowed.empty() ||
         std::find(path.allowed.begin(), path.allowed.end(), entry) != path.allowed.end();
}

// The visits done so far, and which paths may come next. What is legal so far can always be
// completed: the nodes that were begun, then the others in the order of their pairs.
class Walk {
 public:
  Walk(const PlanTree& tree, Rest& rest)
      : tree_(tree),
        rest_(rest),
        visited_(tree.plan().paths.size()),
        slot_(static_cast<size_t>(tree.node_count())),
        begun_(static_cast<size_t>(tree.node_count()), kNone),
        done_(static_cast<size_t>(tree.node_count())),
        is_ready_(static_cast<size_t>(tree.first_child(tree.node_count()))) {
    for (int node = 0; node < tree.node_count(); ++node) {
      const absl::Span<const int> children = tree.children(node);
      rest(2 + 2 * children.size() + tree.node(node).before.size());
      for (size_t slot = 0; slot < children.size(); ++slot) {
        slot_[static_cast<size_t>(children[slot])] = static_cast<int>(slot);
      }
      ready_slots_.push_back(ReadySlots(tree.precedence(node), static_cast<int>(children.size()),
                                        [&](int slot) { is_ready_[IndexOf(node, slot)] = true; }));
    }
  }

  bool visited(int path) const { return visited_[static_cast<size_t>(path)]; }

  // The child of some node that must be completed before `path` may come, as far as it is not done
  // yet; -1 if it may come now.
  int NodeBefore(int path) const {
    int child = tree_.leaf(path);
    for (int node = tree_.parent(child); node >= 0; child = node, node = tree_.parent(node)) {
      const int slot = slot_[static_cast<size_t>(child)];
      const int begun = begun_[static_cast<size_t>(node)];
      if (begun == slot) return -1;  // and so the nodes above were begun
      const absl::Span<const int> children = tree_.children(node);
      if (begun != kNone) return children[static_cast<size_t>(begun)];
      if (tree_.node(node).kind == PlanNode::Kind::kInOrder) {
        const int next = done_[static_cast<size_t>(node)];
        if (slot != next) return children[static_cast<size_t>(next)];
      } else if (!is_ready_[IndexOf(node, slot)]) {
        return UndoneBefore(node, child);
      }
    }
    return -1;
  }

  // REQUIRES: NodeBefore(path) < 0, and the path is not visited.
  void Visit(int path) {
    assert(!visited_[static_cast<size_t>(path)] && NodeBefore(path) < 0);
    visited_[static_cast<size_t>(path)] = true;
    int child = tree_.leaf(path);
    for (int node = tree_.parent(child); node >= 0; child = node, node = tree_.parent(node)) {
      int& begun = begun_[static_cast<size_t>(node)];
      if (begun != kNone) break;
      begun = slot_[static_cast<size_t>(child)];
    }
    child = tree_.leaf(path);
    for (int node = tree_.parent(child); node >= 0; child = node, node = tree_.parent(node)) {
      begun_[static_cast<size_t>(node)] = kNone;
      ready_slots_[static_cast<size_t>(node)].Finish(
          slot_[static_cast<size_t>(child)],
          [&](int slot) { is_ready_[IndexOf(node, slot)] = true; });
      if (++done_[static_cast<size_t>(node)] < static_cast<int>(tree_.children(node).size()))
        return;
    }
  }

  // The least path below `node` that is not visited; INT_MAX if there is none.
  int LeastUndone(int node) const {
    if (tree_.is_leaf(node)) {
      const int path = tree_.node(node).path;
      return visited(path) ? INT_MAX : path;
    }
    int least = INT_MAX;
    rest_(tree_.children(node).size());
    for (const int child : tree_.children(node)) least = std::min(least, LeastUndone(child));
    return least;
  }

 private:
  static constexpr int kNone = -1;

  size_t IndexOf(int node, int slot) const {
    return static_cast<size_t>(tree_.first_child(node) + slot);
  }

  // A child of `node` with paths that are not visited, which must come before `child` by the pairs.
  int UndoneBefore(int node, int child) const {
    const PlanNode& of = tree_.node(node);
    const auto at = [&](int position) { return of.children[static_cast<size_t>(position)]; };
    rest_(of.children.size() + 2 * of.before.size());
    std::vector<std::vector<int>> before(of.children.size());
    for (const auto& [first, second] : of.before)
      before[static_cast<size_t>(second)].push_back(first);
    std::vector<bool> seen(of.children.size());
    std::vector<int> open = {static_cast<int>(
        std::find(of.children.begin(), of.children.end(), child) - of.children.begin())};
    int least = INT_MAX;
    int found = child;
    while (!open.empty()) {
      const int position = open.back();
      open.pop_back();
      for (const int first : before[static_cast<size_t>(position)]) {
        if (seen[static_cast<size_t>(first)]) continue;
        seen[static_cast<size_t>(first)] = true;
        open.push_back(first);
        const int path = LeastUndone(at(first));
        if (path < least) std::tie(least, found) = std::make_pair(path, at(first));
      }
    }
    return found;
  }

  const PlanTree& tree_;
  Rest& rest_;
  std::vector<bool> visited_;            // [path]
  std::vector<int> slot_;                // [node] its slot in its parent
  std::vector<int> begun_;               // [node] the slot that was begun and is not yet complete
  std::vector<int> done_;                // [node] complete slots
  std::vector<ReadySlots> ready_slots_;  // [node]
  std::vector<bool> is_ready_;           // [first_child + slot] whether no pair keeps it waiting
};

}  // namespace

std::optional<RouteFault> FindRouteFault(const Plan& plan, const Route& route, Budget* budget) {
  Rest rest(budget);
  const PlanTree tree(plan, budget);
  Walk walk(tree, rest);
  for (size_t i = 0; i < route.size(); ++i) {
    rest(8);
    const auto [path, entry] = route[i];
    if (path < 0 || path >= static_cast<int>(plan.paths.size())) {
      return RouteFault{RouteFault::Kind::kNoPath, i};
    }
    if (walk.visited(path)) return RouteFault{RouteFault::Kind::kRepeated, i};
    if (!MayEnter(plan.paths[static_cast<size_t>(path)], entry)) {
      return RouteFault{RouteFault::Kind::kEntry, i};
    }
    if (const int node = walk.NodeBefore(path); node >= 0) {
      return RouteFault{RouteFault::Kind::kTooEarly, i, walk.LeastUndone(node)};
    }
    walk.Visit(path);
  }
  if (route.size() == plan.paths.size()) return std::nullopt;
  return RouteFault{RouteFault::Kind::kMissing, route.size(), walk.LeastUndone(0)};
}

}  // namespace traverse
