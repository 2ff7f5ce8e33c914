#include "engine/weller/steps/island_layout.h"

#include <cstddef>
#include <map>

#include "engine/base/rest.h"

namespace traverse {
namespace {

constexpr int kMixed = -1;

// The kind of all paths below a node that is any_order over leaves, as Path::Kind; kMixed if it is
// another node or has paths of both kinds. Appends the paths to `paths`.
int LeavesOfOneKind(const Plan& plan, const PlanNode& node, std::vector<int>& paths) {
  if (node.kind != PlanNode::Kind::kAnyOrder || !node.before.empty()) return kMixed;
  int kind = kMixed;
  for (const int child : node.children) {
    const PlanNode& leaf = plan.nodes[static_cast<size_t>(child)];
    if (leaf.kind != PlanNode::Kind::kPath) return kMixed;
    const int leaf_kind = static_cast<int>(plan.paths[static_cast<size_t>(leaf.path)].kind);
    if (child != node.children.front() && leaf_kind != kind) return kMixed;
    kind = leaf_kind;
    paths.push_back(leaf.path);
  }
  return kind;
}

// Adds the paths of `node` to the stage that they belong to. False if that is not possible.
bool AddStage(const Plan& plan, const PlanNode& node, ClassicalLayer& layer) {
  std::vector<int> paths;
  const int kind = LeavesOfOneKind(plan, node, paths);
  if (kind == static_cast<int>(Path::Kind::kContour)) {
    if (!layer.contours.empty() || !layer.rasters.empty()) return false;
    layer.contours = paths;
    return true;
  }
  if (kind == static_cast<int>(Path::Kind::kOpen)) {
    if (!layer.rasters.empty()) return false;
    layer.rasters = paths;
    return true;
  }
  return node.kind == PlanNode::Kind::kAnyOrder && node.children.empty();
}

}  // namespace

IslandLayout IslandsOf(const Plan& plan, Budget* budget) {
  Rest rest(budget);
  IslandLayout layout;
  layout.island_of.reserve(plan.paths.size());
  std::map<int, int> index_of;  // by Path::island
  for (size_t p = 0; p < plan.paths.size(); ++p) {
    rest(64);
    const Path& path = plan.paths[p];
    int index = static_cast<int>(layout.islands.size());
    if (path.island >= 0) index = index_of.emplace(path.island, index).first->second;
    if (index == static_cast<int>(layout.islands.size())) layout.islands.emplace_back();
    Island& island = layout.islands[static_cast<size_t>(index)];
    layout.island_of.push_back(index);
    if (path.kind == Path::Kind::kOpen) {
      island.rasters.push_back(static_cast<int>(p));
      continue;
    }
    island.contours.push_back(static_cast<int>(p));
    if (path.outer && island.outer < 0) island.outer = static_cast<int>(p);
  }
  return layout;
}

std::optional<ClassicalLayer> AsClassicalLayer(const Plan& plan) {
  ClassicalLayer layer;
  if (plan.nodes.empty()) return layer;
  const PlanNode& root = plan.nodes.front();
  if (root.kind == PlanNode::Kind::kAnyOrder) {
    return AddStage(plan, root, layer) ? std::optional(layer) : std::nullopt;
  }
  if (root.kind != PlanNode::Kind::kInOrder) return std::nullopt;
  for (const int child : root.children) {
    if (!AddStage(plan, plan.nodes[static_cast<size_t>(child)], layer)) return std::nullopt;
  }
  return layer;
}

}  // namespace traverse
