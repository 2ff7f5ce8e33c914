#include "client/gcode/plan/layer_plan.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "client/gcode/model/loops.h"
#include "client/gcode/model/part_links.h"
#include "client/gcode/plan/path_rules.h"
#include "client/gcode/plan/precedence.h"

namespace traverse::gcode {
namespace {

// Each path of the layer has its own fan stated before it, which does not change within it.
bool StatesEachFan(const GcodeFile& file, const Layer& layer) {
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    if ((file.blocks[b].flags & (kBlockOwnFan | kBlockFan)) != kBlockOwnFan) return false;
  }
  return true;
}

class LayerPlanner {
 public:
  LayerPlanner(const GcodeFile& file, const Layer& layer, Policy policy, const Allowance& allow)
      : file_(file),
        policy_(policy),
        fan_order_(allow.fan_order),
        fans_of_paths_(StatesEachFan(file, layer)) {
    result_.outlines = OutlinesOf(file, layer);
    paths_.emplace(file, layer, policy, allow, result_.outlines);
  }

  LayerPlan Make();

 private:
  const Block& BlockOf(size_t path) const { return paths_->BlockOf(path); }
  Feature FeatureOf(size_t path) const { return paths_->FeatureOf(path); }
  size_t size() const { return result_.outlines.size(); }

  const std::vector<PathRule>& rules() const { return result_.freedom.rules; }

  bool BeginsGroup(size_t path) const;

  void AddPath(size_t path);
  uint32_t AddNode(uint32_t parent);
  bool GoesWithBefore(size_t path) const;
  void AddLeaf(uint32_t parent, size_t path);
  void AddGroup(size_t begin, size_t end);
  using Pairs = std::vector<std::pair<uint32_t, uint32_t>>;
  std::pair<Pairs::const_iterator, Pairs::const_iterator> PairsFrom(size_t begin, size_t end) const;

  const GcodeFile& file_;
  const Policy policy_;
  const bool fan_order_;
  const bool fans_of_paths_;
  Contacts contacts_;
  std::vector<uint32_t> position_;  // [path] among the children of its any_order
  LayerPlan result_;
  std::optional<PathRules> paths_;  // of result_.outlines
};

bool LayerPlanner::BeginsGroup(size_t path) const {
  if (path == 0 || rules()[path].pinned || rules()[path - 1].pinned) return true;
  if (IsBoundary(BlockOf(path))) return true;
  if ((FeatureOf(path) == Feature::kSkirt) != (FeatureOf(path - 1) == Feature::kSkirt)) return true;
  if (IsFree(policy_) || fan_order_ || fans_of_paths_) return false;
  const PrintState& state = file_.states[BlockOf(path).state_in];
  const PrintState& before = file_.states[BlockOf(path - 1).state_in];
  for (size_t slot = 0; slot < kSlotCount; ++slot) {
    if (((kFanSlots >> slot) & 1u) != 0 && state[slot] != before[slot]) return true;
  }
  return false;
}

void LayerPlanner::AddPath(size_t path) {
  const Outline& outline = result_.outlines[path];
  const PathRule& rule = rules()[path];
  v1::PlanPath& added = *result_.plan.add_paths();
  const auto add_points = [&outline](size_t count, auto& message) {
    message.mutable_points()->Reserve(static_cast<int>(2 * count));
    for (size_t k = 0; k < count; ++k) {
      message.add_points(outline.points[k].x);
      message.add_points(outline.points[k].y);
    }
  };
  if (rule.contour) {
    v1::Contour& contour = *added.mutable_contour();
    contour.set_id(path + 1);
    add_points(outline.points.size() - 1, contour);
    contour.mutable_entries()->Add(rule.entries.begin(), rule.entries.end());
  } else {
    v1::OpenPath& open = *added.mutable_open_path();
    open.set_id(path + 1);
    add_points(outline.points.size(), open);
    open.set_one_way(rule.one_way);
  }
}

// Adds a node and makes it the last child of `parent`.
uint32_t LayerPlanner::AddNode(uint32_t parent) {
  const auto index = static_cast<uint32_t>(result_.plan.nodes_size());
  result_.plan.add_nodes();
  v1::PlanNode& node = *result_.plan.mutable_nodes(static_cast<int>(parent));
  if (node.has_in_order()) {
    node.mutable_in_order()->add_children(index);
  } else {
    node.mutable_any_order()->add_children(index);
  }
  return index;
}

std::pair<LayerPlanner::Pairs::const_iterator, LayerPlanner::Pairs::const_iterator>
LayerPlanner::PairsFrom(size_t begin, size_t end) const {
  const auto from = [this](size_t path) {
    return std::lower_bound(contacts_.ordered.begin(), contacts_.ordered.end(),
                            std::pair<uint32_t, uint32_t>(static_cast<uint32_t>(path), 0u));
  };
  return {from(begin), from(end)};
}

// True if `path` and the one before it are lines of ironing.
bool LayerPlanner::GoesWithBefore(size_t path) const {
  return FeatureOf(path) == Feature::kIroning && FeatureOf(path - 1) == Feature::kIroning;
}

void LayerPlanner::AddLeaf(uint32_t parent, size_t path) {
  const uint32_t leaf = AddNode(parent);
  result_.plan.mutable_nodes(static_cast<int>(leaf))->set_path(static_cast<uint32_t>(path));
}

void LayerPlanner::AddGroup(size_t begin, size_t end) {
  const uint32_t group = AddNode(0);
  if (end - begin == 1) {
    result_.plan.mutable_nodes(static_cast<int>(group))->set_path(static_cast<uint32_t>(begin));
    return;
  }
  result_.movable += static_cast<int64_t>(end - begin);
  result_.plan.mutable_nodes(static_cast<int>(group))->mutable_any_order();
  uint32_t units = 0;
  for (size_t path = begin; path < end;) {
    size_t behind = path + 1;
    for (; behind < end && GoesWithBefore(behind); ++behind) {
      result_.freedom.goes_on[behind] = true;
    }
    uint32_t parent = group;
    if (behind - path > 1) {
      parent = AddNode(group);
      result_.plan.mutable_nodes(static_cast<int>(parent))->mutable_in_order();
    }
    for (; path < behind; ++path) {
      position_[path] = units;
      AddLeaf(parent, path);
    }
    ++units;
  }
  v1::AnyOrder& any = *result_.plan.mutable_nodes(static_cast<int>(group))->mutable_any_order();
  const auto [first, last] = PairsFrom(begin, end);
  std::set<std::pair<uint32_t, uint32_t>> known;
  for (auto pair = first; pair != last; ++pair) {
    if (pair->second >= end) continue;
    const std::pair<uint32_t, uint32_t> units_of(position_[pair->first], position_[pair->second]);
    if (units_of.first == units_of.second || !known.insert(units_of).second) continue;
    v1::Precedence& before = *any.add_before();
    before.set_first(units_of.first);
    before.set_second(units_of.second);
  }
}

LayerPlan LayerPlanner::Make() {
  position_.resize(size());
  LayerFreedom& freedom = result_.freedom;
  freedom.rules.reserve(size());
  for (size_t path = 0; path < size(); ++path) freedom.rules.push_back(paths_->RuleOf(path));
  contacts_ = FindContacts(result_.outlines,
                           [this](uint32_t i, uint32_t j) { return paths_->KeepsOrder(i, j); });
  result_.island = contacts_.island;
  freedom.island = contacts_.island;
  freedom.ordered = contacts_.ordered;
  freedom.goes_on.assign(size(), false);
  freedom.group.reserve(size());
  result_.plan.add_nodes()->mutable_in_order();
  for (size_t path = 0; path < size(); ++path) AddPath(path);
  for (size_t begin = 0; begin < size();) {
    size_t end = begin + 1;
    while (end < size() && contacts_.complete && !BeginsGroup(end)) ++end;
    freedom.group.resize(end, static_cast<uint32_t>(begin));
    AddGroup(begin, end);
    begin = end;
  }
  return std::move(result_);
}

}  // namespace

LayerPlan MakeLayerPlan(const GcodeFile& file, const Layer& layer, Policy policy,
                        const Allowance& allow) {
  return LayerPlanner(file, layer, policy, allow).Make();
}

LayerFreedom FreedomOf(const GcodeFile& file, const Layer& layer, Policy policy,
                       const Allowance& allow) {
  return std::move(MakeLayerPlan(file, layer, policy, allow).freedom);
}

}  // namespace traverse::gcode
