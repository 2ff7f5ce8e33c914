// Two paths within 0.5 mm keep their order if one is a wall and the other is not, or one is
// ironing, a bridge, support or skirt; under `safe` and `balanced` walls among each other and the
// lines of a monotonic surface or of ironing do so as well, and what a change of the fan parts.

#include <algorithm>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr double kNearMm = 0.5;
constexpr double kCellMm = 1.0;

enum class Group : uint8_t {
  kWall,
  kInfill,
  kMonotonic,
  kIroning,
  kBridge,
  kSupport,
  kInterface,
  kSkirt,
  kOther
};

Group GroupOf(PathClass path_class, const SlicerSettings& settings) {
  switch (path_class) {
    case PathClass::kOuterWall:
    case PathClass::kInnerWall:
    case PathClass::kOverhang:
    case PathClass::kWall:
      return Group::kWall;
    case PathClass::kTop:
      return settings.monotonic_top ? Group::kMonotonic : Group::kInfill;
    case PathClass::kBottom:
      return settings.monotonic_bottom ? Group::kMonotonic : Group::kInfill;
    case PathClass::kIroning:
      return Group::kIroning;
    case PathClass::kBridge:
      return Group::kBridge;
    case PathClass::kSupport:
      return Group::kSupport;
    case PathClass::kInterface:
      return Group::kInterface;
    case PathClass::kSkirt:
      return Group::kSkirt;
    case PathClass::kTower:
    case PathClass::kScript:
      return Group::kOther;
    default:
      return Group::kInfill;
  }
}

class OrderKeeper {
 public:
  OrderKeeper(const LayerPair& layer, const RuleContext& context)
      : layer_(layer), permissions_(context.permissions) {
    for (uint32_t path = layer.first_path_was(); path < layer.end_path_was(); ++path) {
      groups_.push_back(GroupOf(layer.ClassOf(path), context.settings));
      fans_of_paths_ &= layer.was().paths[path].states_fan;
    }
  }

  void Check(size_t section, LayerFindings& findings) {
    const absl::Span<const Visit> visits = layer_.SectionVisits(section);
    const TraceSection& was = layer_.SectionWas(section);
    place_.assign(was.end_path - was.first_path, UINT32_MAX);
    bool as_sliced = true;
    for (uint32_t i = 0; i < visits.size(); ++i) {
      uint32_t& place = place_[visits[i].path - was.first_path];
      if (place == UINT32_MAX) place = i;
      as_sliced &= i == 0 || visits[i].path >= visits[i - 1].path;
    }
    if (as_sliced) return;
    first_ = was.first_path;
    CheckSkirts(visits, findings);
    CheckTowers(visits, findings);
    if (careful() && !permissions_.fan_order && !fans_of_paths_) CheckFans(visits, findings);
    CheckNear(was, visits, findings);
  }

 private:
  Group GroupAt(uint32_t path) const { return groups_[path - layer_.first_path_was()]; }
  uint32_t PlaceOf(uint32_t path) const { return place_[path - first_]; }

  bool careful() const { return !permissions_.is_free(); }

  bool Matters(Group a, Group b) const {
    if (a == Group::kOther || b == Group::kOther) return false;
    if (a == b) {
      if (a == Group::kWall) return careful() && !permissions_.wall_order;
      return (careful() && a == Group::kMonotonic) || a == Group::kIroning;
    }
    const auto is = [a, b](Group group) { return a == group || b == group; };
    if (is(Group::kIroning) || is(Group::kBridge) || is(Group::kSupport) || is(Group::kInterface) ||
        is(Group::kSkirt)) {
      return true;
    }
    return is(Group::kWall) && !permissions_.infill_order;
  }

  // A skirt is seldom near anything, but it must be printed first.
  void CheckSkirts(absl::Span<const Visit> visits, LayerFindings& findings) {
    uint32_t latest = 0;  // of those printed so far, the one that is the last in the original
    bool any = false;
    for (const Visit& visit : visits) {
      if (GroupAt(visit.path) == Group::kOther) continue;
      if (GroupAt(visit.path) != Group::kSkirt) {
        if (!any || visit.path > latest) latest = visit.path;
        any = true;
      } else if (any && latest > visit.path) {
        Report(visit.path, latest, visits, findings);
        return;
      }
    }
  }

  // A tower cleans the nozzle for what comes next, and a script has reasons of its own: nothing
  // passes them.
  void CheckTowers(absl::Span<const Visit> visits, LayerFindings& findings) {
    uint32_t latest = first_;        // of those printed so far, the last one of the original
    uint32_t latest_tower = first_;  // the same of towers and scripts
    for (const Visit& visit : visits) {
      const bool tower = GroupAt(visit.path) == Group::kOther;
      const uint32_t behind = tower ? latest : latest_tower;
      if (visit.path < behind) return Report(visit.path, behind, visits, findings);
      latest = std::max(latest, visit.path);
      if (tower) latest_tower = std::max(latest_tower, visit.path);
    }
  }

  // Fans take time to change: what comes before such a change stays before it; unless the layer
  // states the fan of each path, as a part of that.
  void CheckFans(absl::Span<const Visit> visits, LayerFindings& findings) {
    std::vector<uint32_t> changes(place_.size(), 0);  // [path - first_], so far
    for (size_t i = 1; i < changes.size(); ++i) {
      const TracePath* path = &layer_.was().paths[first_ + i];
      changes[i] = changes[i - 1] + (path->fan != (path - 1)->fan ? 1 : 0);
    }
    uint32_t latest = first_;
    for (const Visit& visit : visits) {
      if (changes[visit.path - first_] < changes[latest - first_]) {
        return Report(visit.path, latest, visits, findings);
      }
      latest = std::max(latest, visit.path);
    }
  }

  void CheckNear(const TraceSection& was, absl::Span<const Visit> visits, LayerFindings& findings) {
    std::vector<Piece> pieces;
    for (uint32_t path = was.first_path; path < was.end_path; ++path) {
      const absl::Span<const Piece> own = layer_.PiecesOf(path);
      pieces.insert(pieces.end(), own.begin(), own.end());
    }
    const PieceGrid grid(std::move(pieces), kCellMm);
    std::vector<uint32_t> reported;
    for (const Piece& piece : grid.pieces()) {
      const uint32_t path = piece.path;
      const Group group = GroupAt(path);
      grid.ForEachNear(piece.a, piece.b, kNearMm, [&](uint32_t i) {
        const Piece& other = grid.pieces()[i];
        // Each pair from its later one, which is printed too early.
        if (other.path >= path || PlaceOf(other.path) <= PlaceOf(path)) return true;
        if (!Matters(group, GroupAt(other.path))) return true;
        if (DistanceOfPieces(piece.a, piece.b, other.a, other.b) > kNearMm) return true;
        if (std::find(reported.begin(), reported.end(), path) != reported.end()) return false;
        reported.push_back(path);
        Report(other.path, path, visits, findings);
        return false;
      });
    }
  }

  // `later` comes before `earlier`.
  void Report(uint32_t earlier, uint32_t later, absl::Span<const Visit> visits,
              LayerFindings& findings) {
    const TraceChunk& was = layer_.was();
    const TraceChunk& is = layer_.is();
    const Visit& visit = visits[PlaceOf(later)];
    findings.breaks.push_back({VerifyRule::kOrder, was.LineOf(was.paths[later]),
                               is.segments[visit.first_segment].line, layer_.index(),
                               absl::StrFormat("this %s is printed before the %s of line %d of the "
                                               "original, but there it comes after it",
                                               std::string(PathClassName(layer_.ClassOf(later))),
                                               std::string(PathClassName(layer_.ClassOf(earlier))),
                                               was.LineOf(was.paths[earlier]))});
  }

  const LayerPair& layer_;
  const VerifyPermissions permissions_;
  std::vector<Group> groups_;    // [path - first path of the layer]
  std::vector<uint32_t> place_;  // [path - first path of the section] in the section's visits
  uint32_t first_ = 0;
  bool fans_of_paths_ = true;  // each path of the layer states its own
};

// Objects that touch keep their order: what one of them rests on may be of the other.
void CheckMovedObjects(const LayerPair& layer, LayerFindings& findings) {
  const uint32_t first = layer.first_path_was();
  std::vector<uint32_t> section_of(layer.end_path_was() - first);
  bool moved = false;
  for (uint32_t k = 0; k < layer.section_count(); ++k) {
    const TraceSection& was = layer.SectionWas(k);
    moved |= k > 0 && was.first_path < layer.SectionWas(k - 1).first_path;
    std::fill(section_of.begin() + (was.first_path - first),
              section_of.begin() + (was.end_path - first), k);
  }
  if (!moved) return;
  const PieceGrid grid(std::vector<Piece>(layer.pieces()), kCellMm);
  const auto section = [&](const Piece& piece) { return section_of[piece.path - first]; };
  for (const Piece& piece : grid.pieces()) {
    bool found = false;
    grid.ForEachNear(piece.a, piece.b, kNearMm, [&](uint32_t i) {
      const Piece& other = grid.pieces()[i];
      found = other.path < piece.path && section(other) > section(piece) &&
              DistanceOfPieces(piece.a, piece.b, other.a, other.b) <= kNearMm;
      if (!found) return true;
      findings.breaks.push_back(
          {VerifyRule::kOrder, layer.was().LineOf(layer.was().paths[piece.path]),
           layer.is().LineOf(layer.is().paths[layer.SectionIs(section(piece)).first_path]),
           layer.index(),
           absl::StrFormat("this object is printed before one that it touches, which comes before "
                           "it in the original, with line %d",
                           layer.was().LineOf(layer.was().paths[other.path]))});
      return false;
    });
    if (found) return;
  }
}

}  // namespace

void CheckOrder(const LayerPair& layer, const RuleContext& context, LayerFindings& findings) {
  OrderKeeper keeper(layer, context);
  for (size_t k = 0; k < layer.section_count(); ++k) keeper.Check(k, findings);
  CheckMovedObjects(layer, findings);
}

}  // namespace traverse::gcode
