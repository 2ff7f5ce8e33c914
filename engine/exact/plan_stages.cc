#include "engine/exact/plan_stages.h"

#include <cstddef>

namespace traverse {
namespace {

class StageCollector {
 public:
  StageCollector(const Plan& plan, size_t most_children)
      : plan_(plan), most_children_(most_children), paths_below_(plan.nodes.size()) {
    // Children have greater indices than their parents.
    for (size_t i = plan.nodes.size(); i-- > 0;) {
      const PlanNode& node = plan.nodes[i];
      paths_below_[i] = node.kind == PlanNode::Kind::kPath ? 1 : 0;
      for (const int child : node.children) paths_below_[i] += below(child);
    }
  }

  bool Collect(int index) {
    const PlanNode& node = plan_.nodes[static_cast<size_t>(index)];
    if (below(index) == 0) return true;
    if (node.kind == PlanNode::Kind::kPath) {
      stages_.push_back({{node.path}, {}});
      return true;
    }
    int filled = 0;
    int last_filled = 0;
    for (const int child : node.children) {
      if (below(child) == 0) continue;
      ++filled;
      last_filled = child;
      if (node.kind == PlanNode::Kind::kInOrder && !Collect(child)) return false;
    }
    if (node.kind == PlanNode::Kind::kInOrder) return true;
    return filled == 1 ? Collect(last_filled) : CollectAnyOrder(node);
  }

  std::vector<PlanStage> TakeStages() { return std::move(stages_); }

 private:
  int below(int node) const { return paths_below_[static_cast<size_t>(node)]; }

  int OnlyPathBelow(int index) const {
    while (plan_.nodes[static_cast<size_t>(index)].kind != PlanNode::Kind::kPath) {
      for (const int child : plan_.nodes[static_cast<size_t>(index)].children) {
        if (below(child) > 0) index = child;
      }
    }
    return plan_.nodes[static_cast<size_t>(index)].path;
  }

  bool CollectAnyOrder(const PlanNode& node) {
    if (node.children.size() > most_children_) return false;
    PlanStage stage;
    std::vector<int> position(node.children.size(), -1);  // in the stage
    for (size_t c = 0; c < node.children.size(); ++c) {
      const int child = node.children[c];
      if (below(child) == 0) continue;
      if (below(child) > 1) return false;
      position[c] = static_cast<int>(stage.paths.size());
      stage.paths.push_back(OnlyPathBelow(child));
    }
    for (const auto& [first, second] : Closure(node)) {
      const int i = position[static_cast<size_t>(first)];
      const int j = position[static_cast<size_t>(second)];
      if (i >= 0 && j >= 0) stage.before.emplace_back(i, j);
    }
    stages_.push_back(std::move(stage));
    return true;
  }

  // All pairs that follow from `before`, those through children without paths included (Warshall).
  static std::vector<std::pair<int, int>> Closure(const PlanNode& node) {
    std::vector<std::pair<int, int>> pairs;
    if (node.before.empty()) return pairs;
    const size_t n = node.children.size();
    std::vector<std::vector<bool>> reaches(n, std::vector<bool>(n));
    for (const auto& [first, second] : node.before) {
      reaches[static_cast<size_t>(first)][static_cast<size_t>(second)] = true;
    }
    for (size_t via = 0; via < n; ++via) {
      for (size_t i = 0; i < n; ++i) {
        if (!reaches[i][via]) continue;
        for (size_t j = 0; j < n; ++j) reaches[i][j] = reaches[i][j] || reaches[via][j];
      }
    }
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = 0; j < n; ++j) {
        if (reaches[i][j]) pairs.emplace_back(static_cast<int>(i), static_cast<int>(j));
      }
    }
    return pairs;
  }

  const Plan& plan_;
  const size_t most_children_;
  std::vector<int> paths_below_;  // [node]
  std::vector<PlanStage> stages_;
};

}  // namespace

std::optional<std::vector<PlanStage>> StagesOf(const Plan& plan, size_t most_children) {
  if (plan.nodes.empty()) return std::vector<PlanStage>();
  StageCollector collector(plan, most_children);
  if (!collector.Collect(0)) return std::nullopt;
  return collector.TakeStages();
}

}  // namespace traverse
