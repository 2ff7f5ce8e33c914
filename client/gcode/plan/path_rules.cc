#include "client/gcode/plan/path_rules.h"

#include <algorithm>
#include <optional>
#include <string>

#include "absl/types/span.h"
#include "client/gcode/plan/loop_starts.h"

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
  switch (feature) {
    case Feature::kLoop:
    case Feature::kOuterWall:
    case Feature::kInnerWall:
    case Feature::kOverhangWall:
      return Kind::kWall;
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

}  // namespace

PathRules::PathRules(const GcodeFile& file, const Layer& layer, Policy policy,
                     const Allowance& allow, const std::vector<Outline>& outlines)
    : file_(file),
      first_block_(layer.first_block),
      policy_(policy),
      allow_(allow),
      outlines_(outlines) {}

bool PathRules::IsPinned(size_t path) const {
  const size_t block = first_block_ + path;
  const bool last = block + 1 == file_.blocks.size();
  const Feature feature = FeatureOf(path);
  return (BlockOf(path).flags & kBlockPinned) != 0 || (BlockOf(path).link & kLinkFixed) != 0 ||
         last || (file_.blocks[block + 1].link & (kLinkFixed | kLinkFixedFrom)) != 0 ||
         feature == Feature::kTower || feature == Feature::kCustom;
}

// Monotonic surfaces and ironing get their look from the order of their lines.
bool PathRules::OrderIsQuality(Feature feature) const {
  if (feature == Feature::kIroning) return true;
  if (IsFree(policy_)) return false;
  if (feature == Feature::kBottomInfill) return file_.profile.monotonic_bottom;
  if (feature != Feature::kTopInfill) return false;
  const std::optional<std::string>& pattern = file_.profile.top_fill_pattern;
  return !pattern || pattern->starts_with("monotonic");
}

bool PathRules::MayBeginAnywhere(size_t path) const {
  constexpr uint16_t kFixing =
      kBlockTail | kBlockCoast | kBlockCommand | kBlockType | kBlockComments | kBlockPinned;
  if ((BlockOf(path).flags & kFixing) != 0 || Rises(path)) return false;
  if (policy_ != Policy::kSafe) return true;
  const Feature feature = FeatureOf(path);
  return feature != Feature::kOuterWall && feature != Feature::kLoop &&
         feature != Feature::kOverhangWall;
}

bool PathRules::MayTurnRound(size_t path) const {
  constexpr uint16_t kFixing =
      kBlockCoast | kBlockCommand | kBlockType | kBlockComments | kBlockPinned;
  const Feature feature = FeatureOf(path);
  if ((BlockOf(path).flags & kFixing) != 0 || OrderIsQuality(feature)) return false;
  if (HasFullCircle(path) || Rises(path)) return false;
  return IsFree(policy_) || !IsWall(feature);
}

// A scarf seam rises from its start to the height of the layer.
bool PathRules::Rises(size_t path) const { return BlockOf(path).first.z != BlockOf(path).last.z; }

// Its direction is all that says which way round such an arc goes, as both its ends are one point.
bool PathRules::HasFullCircle(size_t path) const {
  if ((BlockOf(path).flags & kBlockArcs) == 0) return false;
  const std::vector<Point>& points = outlines_[path].points;
  return std::adjacent_find(points.begin(), points.end()) != points.end();
}

PathRule PathRules::RuleOf(size_t path) const {
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
    const bool at_corners = policy_ == Policy::kBalanced &&
                            outline.feature != Feature::kInnerWall && IsWall(outline.feature);
    rule.entries = ThinnedStarts(loop, at_corners ? SharpCorners(loop) : std::vector<uint32_t>());
  }
  return rule;
}

bool PathRules::KeepsOrder(size_t i, size_t j) const {
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

}  // namespace traverse::gcode
