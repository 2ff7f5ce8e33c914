#include "client/gcode/plan/layer_plan.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "absl/types/span.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/model/part_links.h"
#include "client/gcode/model/visible_walls.h"
#include "client/gcode/plan/loop_starts.h"
#include "client/gcode/plan/precedence.h"

namespace traverse::gcode {
namespace {

// The vertices of a closed outline. The last point is the first again, or lies so near to it that
// to begin there would only cross the gap first.
absl::Span<const Point> ContourVertices(const Outline& outline) {
  return absl::MakeConstSpan(outline.points).first(outline.points.size() - 1);
}

// The role of a path for the order of others. Lines of different infills may lie side by side in
// any order, but not infill that lies against a wall.
enum class Kind { kWall, kFill, kBridge, kIroning, kSupport, kOther };

Kind KindOf(Feature feature) {
  if (IsWall(feature)) return Kind::kWall;
  switch (feature) {
    case Feature::kLine:
    case Feature::kGapFill:
    case Feature::kSparseInfill:
    case Feature::kSolidInfill:
    case Feature::kBottomInfill:
    case Feature::kTopInfill:
      return Kind::kFill;
    case Feature::kBridge:
      return Kind::kBridge;
    case Feature::kIroning:
      return Kind::kIroning;
    case Feature::kSupport:
    case Feature::kSupportInterface:
      return Kind::kSupport;
    default:
      return Kind::kOther;
  }
}

// How each path of a layer may be printed, and which pairs of paths keep their order.
class PathRules {
 public:
  // All outlive the rules; `outlines` belong to the paths of `layer`.
  PathRules(const GcodeFile& file, const Layer& layer, Policy policy, const Allowance& allow,
            const std::vector<Outline>& outlines)
      : file_(file), layer_(layer), policy_(policy), allow_(allow), outlines_(outlines) {}

  PathRule RuleOf(size_t path) const {
    PathRule rule;
    const Outline& outline = outlines_[path];
    rule.pinned = IsPinned(path);
    rule.contour = outline.closed;
    if (!rule.contour) {
      rule.one_way = rule.pinned || !MayTurnRound(path);
    } else if (rule.pinned || outline.one_start || !MayBeginAnywhere(path)) {
      rule.entries = {0};
    } else {
      const absl::Span<const Point> loop = ContourVertices(outline);
      const bool at_corners = policy_ == Policy::kBalanced && IsVisibleWall(outline.feature);
      rule.entries = ThinnedStarts(loop, at_corners ? SharpCorners(loop) : std::vector<uint32_t>());
    }
    return rule;
  }

  // True if paths `i` and `j`, which touch, keep their sliced order.
  bool KeepsOrder(size_t i, size_t j) const {
    const Feature a = FeatureOf(i);
    const Feature b = FeatureOf(j);
    const Kind kind = KindOf(a);
    const Kind other = KindOf(b);
    const bool wall_and_fill = (kind == Kind::kWall && other == Kind::kFill) ||
                               (kind == Kind::kFill && other == Kind::kWall);
    if (wall_and_fill && allow_.infill_order) return false;
    if (kind != other || kind == Kind::kIroning) return true;
    if (kind == Kind::kSupport) return a != b || a == Feature::kSupportInterface;
    if (IsFree(policy_)) return false;
    if (kind == Kind::kWall) return !allow_.wall_order;
    return OrderIsQuality(a) && a == b;
  }

 private:
  Feature FeatureOf(size_t path) const { return outlines_[path].feature; }
  const Block& BlockOf(size_t path) const { return file_.blocks[layer_.first_block + path]; }

  bool IsPinned(size_t path) const {
    const size_t block = layer_.first_block + path;
    const bool last = block + 1 == file_.blocks.size();
    const Feature feature = FeatureOf(path);
    return (BlockOf(path).flags & kBlockPinned) != 0 || (BlockOf(path).link & kLinkFixed) != 0 ||
           last || (file_.blocks[block + 1].link & (kLinkFixed | kLinkFixedFrom)) != 0 ||
           feature == Feature::kTower || feature == Feature::kCustom;
  }

  // Monotonic surfaces and ironing get their look from the order of their lines.
  bool OrderIsQuality(Feature feature) const {
    if (feature == Feature::kIroning) return true;
    if (IsFree(policy_)) return false;
    if (feature == Feature::kBottomInfill) return file_.profile.monotonic_bottom;
    if (feature != Feature::kTopInfill) return false;
    const std::optional<std::string>& pattern = file_.profile.top_fill_pattern;
    return !pattern || pattern->starts_with("monotonic");
  }

  bool MayBeginAnywhere(size_t path) const {
    if (IsFixed(path) || (BlockOf(path).flags & kBlockTail) != 0) return false;
    return policy_ != Policy::kSafe || !IsVisibleWall(FeatureOf(path));
  }

  bool MayTurnRound(size_t path) const {
    const Feature feature = FeatureOf(path);
    if (IsFixed(path) || OrderIsQuality(feature) || HasFullCircle(path)) return false;
    return IsFree(policy_) || !IsWall(feature);
  }

  // It is printed from its start to its end: what is inside it holds from there on, and a scarf
  // seam rises from its start to the height of the layer.
  bool IsFixed(size_t path) const {
    const Block& block = BlockOf(path);
    return (block.flags & (kBlockCoast | kBlockCommand | kBlockType | kBlockComments)) != 0 ||
           block.first.z != block.last.z;
  }

  // Its direction is all that says which way round such an arc goes, as both its ends are one
  // point.
  bool HasFullCircle(size_t path) const {
    if ((BlockOf(path).flags & kBlockArcs) == 0) return false;
    const std::vector<Point>& points = outlines_[path].points;
    return std::adjacent_find(points.begin(), points.end()) != points.end();
  }

  const GcodeFile& file_;
  const Layer& layer_;
  const Policy policy_;
  const Allowance& allow_;
  const std::vector<Outline>& outlines_;
};

// Each path of the layer has its own fan stated before it, which does not change within it.
bool StatesEachFan(const GcodeFile& file, const Layer& layer) {
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    if ((file.blocks[b].flags & (kBlockOwnFan | kBlockFan)) != kBlockOwnFan) return false;
  }
  return true;
}

// What may change in a layer whose paths have these outlines.
LayerFreedom FreedomWith(const GcodeFile& file, const Layer& layer,
                         const std::vector<Outline>& outlines, Policy policy,
                         const Allowance& allow) {
  LayerFreedom freedom;
  const PathRules paths(file, layer, policy, allow, outlines);
  for (size_t path = 0; path < outlines.size(); ++path) {
    freedom.rules.push_back(paths.RuleOf(path));
  }
  Contacts contacts =
      FindContacts(outlines, [&](uint32_t i, uint32_t j) { return paths.KeepsOrder(i, j); });
  freedom.island = std::move(contacts.island);
  freedom.ordered = std::move(contacts.ordered);
  const bool any_fan = IsFree(policy) || allow.fan_order || StatesEachFan(file, layer);
  const auto is = [&](uint32_t path, Feature feature) { return outlines[path].feature == feature; };
  const auto begins_group = [&](uint32_t path) {
    if (path == 0 || freedom.rules[path].pinned || freedom.rules[path - 1].pinned) return true;
    const uint32_t block = layer.first_block + path;
    return IsBoundary(file.blocks[block]) ||
           is(path, Feature::kSkirt) != is(path - 1, Feature::kSkirt) ||
           (!any_fan && FanChanges(file, block));
  };
  for (uint32_t path = 0; path < outlines.size(); ++path) {
    const bool begins = !contacts.complete || begins_group(path);
    freedom.group.push_back(begins ? path : freedom.group.back());
    freedom.goes_on.push_back(!begins && is(path, Feature::kIroning) &&
                              is(path - 1, Feature::kIroning));
  }
  return freedom;
}

v1::PlanPath PlanPathOf(const Outline& outline, const PathRule& rule, size_t path) {
  v1::PlanPath made;
  const auto add_points = [&outline](size_t count, auto& message) {
    message.mutable_points()->Reserve(static_cast<int>(2 * count));
    for (size_t k = 0; k < count; ++k) {
      message.add_points(outline.points[k].x);
      message.add_points(outline.points[k].y);
    }
  };
  if (rule.contour) {
    v1::Contour& contour = *made.mutable_contour();
    contour.set_id(path + 1);
    add_points(outline.points.size() - 1, contour);
    contour.mutable_entries()->Add(rule.entries.begin(), rule.entries.end());
  } else {
    v1::OpenPath& open = *made.mutable_open_path();
    open.set_id(path + 1);
    add_points(outline.points.size(), open);
    open.set_one_way(rule.one_way);
  }
  return made;
}

v1::PlanNode& NodeOf(v1::Plan& plan, uint32_t index) {
  return *plan.mutable_nodes(static_cast<int>(index));
}

// Adds a node and makes it the last child of `parent`.
uint32_t AddNode(uint32_t parent, v1::Plan& plan) {
  const auto index = static_cast<uint32_t>(plan.nodes_size());
  plan.add_nodes();
  v1::PlanNode& node = NodeOf(plan, parent);
  if (node.has_in_order()) {
    node.mutable_in_order()->add_children(index);
  } else {
    node.mutable_any_order()->add_children(index);
  }
  return index;
}

// Adds the paths [begin, end), which may change places.
void AddGroup(uint32_t begin, uint32_t end, const LayerFreedom& freedom, v1::Plan& plan) {
  const uint32_t group = AddNode(0, plan);
  NodeOf(plan, group).mutable_any_order();
  std::vector<uint32_t> position;  // [path - begin] among the children of the group
  for (uint32_t path = begin; path < end;) {
    const auto unit = static_cast<uint32_t>(NodeOf(plan, group).any_order().children_size());
    uint32_t behind = path + 1;
    while (behind < end && freedom.goes_on[behind]) ++behind;
    uint32_t parent = group;
    if (behind - path > 1) {
      parent = AddNode(group, plan);
      NodeOf(plan, parent).mutable_in_order();
    }
    for (; path < behind; ++path) {
      position.push_back(unit);
      NodeOf(plan, AddNode(parent, plan)).set_path(path);
    }
  }
  v1::AnyOrder& any = *NodeOf(plan, group).mutable_any_order();
  std::set<std::pair<uint32_t, uint32_t>> known;
  auto pair = std::ranges::lower_bound(freedom.ordered, std::pair(begin, 0u));
  for (; pair != freedom.ordered.end() && pair->first < end; ++pair) {
    if (pair->second >= end) continue;
    const std::pair units(position[pair->first - begin], position[pair->second - begin]);
    if (units.first == units.second || !known.insert(units).second) continue;
    v1::Precedence& before = *any.add_before();
    before.set_first(units.first);
    before.set_second(units.second);
  }
}

}  // namespace

bool FanChanges(const GcodeFile& file, uint32_t block) {
  const PrintState& before = file.states[file.blocks[block - 1].state_in];
  const PrintState& behind = file.states[file.blocks[block].state_in];
  for (size_t slot = 0; slot < kSlotCount; ++slot) {
    if (((kFanSlots >> slot) & 1u) != 0 && before[slot] != behind[slot]) return true;
  }
  return false;
}

LayerPlan MakeLayerPlan(const GcodeFile& file, const Layer& layer, Policy policy,
                        const Allowance& allow) {
  LayerPlan made;
  made.outlines = OutlinesOf(file, layer);
  made.freedom = FreedomWith(file, layer, made.outlines, policy, allow);
  const auto paths = static_cast<uint32_t>(made.outlines.size());
  for (uint32_t path = 0; path < paths; ++path) {
    *made.plan.add_paths() = PlanPathOf(made.outlines[path], made.freedom.rules[path], path);
  }
  made.plan.add_nodes()->mutable_in_order();
  for (uint32_t begin = 0, end = 0; begin < paths; begin = end) {
    while (end < paths && made.freedom.group[end] == begin) ++end;
    if (end - begin == 1) {
      NodeOf(made.plan, AddNode(0, made.plan)).set_path(begin);
    } else {
      AddGroup(begin, end, made.freedom, made.plan);
      made.movable += end - begin;
    }
  }
  return made;
}

LayerFreedom FreedomOf(const GcodeFile& file, const Layer& layer, Policy policy,
                       const Allowance& allow) {
  return FreedomWith(file, layer, OutlinesOf(file, layer), policy, allow);
}

}  // namespace traverse::gcode
