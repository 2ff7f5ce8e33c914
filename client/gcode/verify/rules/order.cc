// Two paths within 0.5 mm keep their order if one is a wall and the other is not, or one is
// ironing, a bridge, support or skirt; under `safe` and `balanced` walls among each other and the
// lines of a monotonic surface or of ironing do so as well, and what a change of the fan parts.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr double kNearMm = 0.5;
constexpr double kCellMm = 1.0;
constexpr size_t kMostPairs = 1000;
constexpr size_t kPairsAlways = 1 << 20;

// Paths of one group have the same reasons to keep their order: those of kTop are the lines of a
// monotonic surface, whatever side it is on, and those of kTower scripts too.
PathClass GroupOf(PathClass path_class, const SlicerSettings& settings) {
  if (IsWallClass(path_class)) return PathClass::kWall;
  switch (path_class) {
    case PathClass::kTop:
      return settings.monotonic_top ? PathClass::kTop : PathClass::kInfill;
    case PathClass::kBottom:
      return settings.monotonic_bottom ? PathClass::kTop : PathClass::kInfill;
    case PathClass::kUnnamed:
    case PathClass::kSkin:
      return PathClass::kInfill;
    case PathClass::kScript:
      return PathClass::kTower;
    default:
      return path_class;
  }
}

// Pieces by the cells that they meet or come within kNearMm / 2 of: two pieces within kNearMm share
// a cell. Cells are larger where pieces are long, so that memory and time are linear.
class Cells {
 public:
  explicit Cells(const std::vector<Piece>& pieces) {
    double length = 0;
    for (const Piece& piece : pieces) {
      length += std::abs(piece.b.x - piece.a.x) + std::abs(piece.b.y - piece.a.y);
    }
    cell_mm_ =
        std::max(kCellMm, length / (kMostEach * static_cast<double>(pieces.size()) + kMostAlways));
    absl::flat_hash_map<std::pair<int, int>, size_t> numbers;  // by row and column
    for (uint32_t i = 0; i < pieces.size(); ++i) {
      ForEachOf(pieces[i], [&](int row, int column) {
        const auto [number, added] = numbers.try_emplace({row, column}, cells_.size());
        if (added) cells_.emplace_back();
        cells_[number->second].push_back(i);
      });
    }
  }

  // The pieces of each cell, in ascending order.
  const std::vector<std::vector<uint32_t>>& cells() const { return cells_; }

 private:
  static constexpr double kMostEach = 8;
  static constexpr double kMostAlways = 1 << 18;

  // What lies farther away than can be counted is in the last one.
  int Number(double mm) const {
    return static_cast<int>(std::clamp(std::floor(mm / cell_mm_), -2e9, 2e9));
  }

  // Row by row: the cells from where the piece, with what is near it, enters the row to where it
  // leaves it.
  template <typename Visit>
  void ForEachOf(const Piece& piece, Visit visit) const {
    constexpr double kReach = kNearMm / 2;
    const auto [a, b] =
        piece.a.y <= piece.b.y ? std::pair(piece.a, piece.b) : std::pair(piece.b, piece.a);
    const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
    const int last = Number(b.y + kReach);
    for (int row = Number(a.y - kReach); row <= last; ++row) {
      const double y_low = std::clamp(row * cell_mm_ - kReach, a.y, b.y);
      const double y_high = std::clamp((row + 1) * cell_mm_ + kReach, a.y, b.y);
      const double one = b.y > a.y ? a.x + (y_low - a.y) * slope : a.x;
      const double other = b.y > a.y ? a.x + (y_high - a.y) * slope : b.x;
      const int end = Number(std::max(one, other) + kReach);
      for (int column = Number(std::min(one, other) - kReach); column <= end; ++column) {
        visit(row, column);
      }
    }
  }

  std::vector<std::vector<uint32_t>> cells_;
  double cell_mm_;
};

class OrderKeeper {
 public:
  OrderKeeper(const LayerPair& layer, const RuleContext& context, LayerFindings& findings)
      : layer_(layer), permissions_(context.permissions), findings_(findings) {
    for (uint32_t path = layer.first_path_was(); path < layer.end_path_was(); ++path) {
      groups_.push_back(GroupOf(layer.ClassOf(path), context.settings));
      fans_of_paths_ &= layer.was().paths[path].states_fan;
    }
  }

  void Check(size_t section) {
    visits_ = layer_.SectionVisits(section);
    const TraceSection& was = layer_.SectionWas(section);
    place_.assign(was.end_path - was.first_path, UINT32_MAX);
    bool as_sliced = true;
    for (uint32_t i = 0; i < visits_.size(); ++i) {
      uint32_t& place = place_[visits_[i].path - was.first_path];
      if (place == UINT32_MAX) place = i;
      as_sliced &= i == 0 || visits_[i].path >= visits_[i - 1].path;
    }
    if (as_sliced) return;
    first_ = was.first_path;
    CheckSkirts();
    CheckTowers();
    if (careful() && !permissions_.fan_order && !fans_of_paths_) CheckFans();
    CheckNear(was);
  }

 private:
  PathClass GroupAt(uint32_t path) const { return groups_[path - layer_.first_path_was()]; }
  uint32_t PlaceOf(uint32_t path) const { return place_[path - first_]; }

  bool careful() const { return !permissions_.is_free(); }

  bool Matters(PathClass a, PathClass b) const {
    if (a == PathClass::kTower || b == PathClass::kTower) return false;
    if (a == b) {
      if (a == PathClass::kWall) return careful() && !permissions_.wall_order;
      return (careful() && a == PathClass::kTop) || a == PathClass::kIroning;
    }
    const auto is = [a, b](PathClass group) { return a == group || b == group; };
    if (is(PathClass::kIroning) || is(PathClass::kBridge) || is(PathClass::kSupport) ||
        is(PathClass::kInterface) || is(PathClass::kSkirt)) {
      return true;
    }
    return is(PathClass::kWall) && !permissions_.infill_order;
  }

  // A skirt is seldom near anything, but it must be printed first.
  void CheckSkirts() {
    uint32_t latest = first_;  // of those printed so far, the one that is the last in the original
    for (const Visit& visit : visits_) {
      const PathClass group = GroupAt(visit.path);
      if (group == PathClass::kSkirt && visit.path < latest) return Report(visit.path, latest);
      const bool passes = group != PathClass::kSkirt && group != PathClass::kTower;
      if (passes) latest = std::max(latest, visit.path);
    }
  }

  // A tower cleans the nozzle for what comes next, and a script has reasons of its own: nothing
  // passes them.
  void CheckTowers() {
    uint32_t latest = first_;        // of those printed so far, the last one of the original
    uint32_t latest_tower = first_;  // the same of towers and scripts
    for (const Visit& visit : visits_) {
      const bool tower = GroupAt(visit.path) == PathClass::kTower;
      const uint32_t behind = tower ? latest : latest_tower;
      if (visit.path < behind) return Report(visit.path, behind);
      latest = std::max(latest, visit.path);
      if (tower) latest_tower = std::max(latest_tower, visit.path);
    }
  }

  // Fans take time to change: what comes before such a change stays before it; unless the layer
  // states the fan of each path, as a part of that.
  void CheckFans() {
    std::vector<uint32_t> changes(place_.size(), 0);  // [path - first_], so far
    for (size_t i = 1; i < changes.size(); ++i) {
      const TracePath* path = &layer_.was().paths[first_ + i];
      changes[i] = changes[i - 1] + (path->fan != (path - 1)->fan ? 1 : 0);
    }
    uint32_t latest = first_;
    for (const Visit& visit : visits_) {
      if (changes[visit.path - first_] < changes[latest - first_]) {
        return Report(visit.path, latest);
      }
      latest = std::max(latest, visit.path);
    }
  }

  // Pieces of one group that lie in one cell and come first in the original.
  struct Earlier {
    std::vector<uint32_t> pieces;  // indices
    uint32_t last_path = 0;        // of those, the one that is printed last
  };

  // Two pieces within kNearMm share a cell, with which their cells begin in the order of the
  // original. Of those before a piece only those of groups that matter to it are looked at, and
  // only if one of them was turned around with it. Where that is more than kMostPairs for each
  // piece of the section, all that share a cell count as near: such a layer is none of a print.
  void CheckNear(const TraceSection& was) {
    std::vector<Piece> pieces;
    for (uint32_t path = was.first_path; path < was.end_path; ++path) {
      const absl::Span<const Piece> own = layer_.PiecesOf(path);
      pieces.insert(pieces.end(), own.begin(), own.end());
    }
    pairs_left_ = kPairsAlways + kMostPairs * pieces.size();
    reported_.assign(place_.size(), false);
    const Cells near(pieces);
    std::array<Earlier, static_cast<size_t>(PathClass::kCount)> earlier;  // by group
    for (const std::vector<uint32_t>& cell : near.cells()) {
      if (layer_.Ended()) return;
      for (Earlier& of_group : earlier) of_group.pieces.clear();
      for (const uint32_t i : cell) {
        const uint32_t path = pieces[i].path;
        const PathClass group = GroupAt(path);
        for (size_t k = 0; k < earlier.size() && !reported_[path - first_]; ++k) {
          if (earlier[k].pieces.empty() || !Matters(group, static_cast<PathClass>(k))) continue;
          const uint32_t other = TurnedNear(pieces, i, earlier[k]);
          if (other == UINT32_MAX) continue;
          reported_[path - first_] = true;
          Report(other, path);
        }
        Earlier& own = earlier[static_cast<size_t>(group)];
        if (own.pieces.empty() || PlaceOf(path) > PlaceOf(own.last_path)) own.last_path = path;
        own.pieces.push_back(i);
      }
    }
  }

  // A path of `earlier` near piece `i` that is printed after it; UINT32_MAX if there is none.
  uint32_t TurnedNear(const std::vector<Piece>& pieces, uint32_t i, const Earlier& earlier) {
    const Piece& piece = pieces[i];
    if (PlaceOf(earlier.last_path) <= PlaceOf(piece.path)) return UINT32_MAX;
    for (const uint32_t k : earlier.pieces) {
      if (pairs_left_ == 0) return earlier.last_path;
      --pairs_left_;
      const Piece& other = pieces[k];
      if (PlaceOf(other.path) <= PlaceOf(piece.path)) continue;
      if (DistanceOfPieces(piece.a, piece.b, other.a, other.b) <= kNearMm) return other.path;
    }
    return UINT32_MAX;
  }

  // `later` comes before `earlier`.
  void Report(uint32_t earlier, uint32_t later) {
    const TraceChunk& was = layer_.was();
    const Visit& visit = visits_[PlaceOf(later)];
    findings_.breaks.push_back(
        {VerifyRule::kOrder, was.LineOf(later), layer_.LineOf(visit),
         absl::StrFormat("this %s is printed before the %s of line %d of the "
                         "original, but there it comes after it",
                         PathClassName(layer_.ClassOf(later)),
                         PathClassName(layer_.ClassOf(earlier)), was.LineOf(earlier)),
         layer_.LineOf(visits_[PlaceOf(earlier)])});
  }

  const LayerPair& layer_;
  const VerifyPermissions permissions_;
  LayerFindings& findings_;
  absl::Span<const Visit> visits_;  // of the section
  std::vector<PathClass> groups_;   // [path - first path of the layer]
  std::vector<uint32_t> place_;     // [path - first path of the section] in the section's visits
  uint32_t first_ = 0;
  bool fans_of_paths_ = true;   // each path of the layer states its own
  std::vector<bool> reported_;  // [path - first_]
  size_t pairs_left_ = 0;
};

// Objects that touch keep their order: what one of them rests on may be of the other.
void CheckMovedObjects(const LayerPair& layer, LayerFindings& findings) {
  const uint32_t first = layer.first_path_was();
  std::vector<uint32_t> section_of(layer.end_path_was() - first);
  bool moved = false;
  for (uint32_t k = 0; k < layer.section_count(); ++k) {
    if (layer.Ended()) return;
    const TraceSection& was = layer.SectionWas(k);
    moved |= k > 0 && was.first_path < layer.SectionWas(k - 1).first_path;
    std::fill(section_of.begin() + (was.first_path - first),
              section_of.begin() + (was.end_path - first), k);
  }
  if (!moved) return;
  const PieceTree tree(layer.pieces());
  const auto section = [&](const Piece& piece) { return section_of[piece.path - first]; };
  for (const Piece& piece : tree.pieces()) {
    if (layer.Ended()) return;
    bool found = false;
    tree.ForEachNear(piece.a, piece.b, kNearMm, [&](uint32_t i) {
      const Piece& other = tree.pieces()[i];
      found = other.path < piece.path && section(other) > section(piece) &&
              DistanceOfPieces(piece.a, piece.b, other.a, other.b) <= kNearMm;
      if (!found) return true;
      findings.breaks.push_back(
          {VerifyRule::kOrder, layer.was().LineOf(piece.path),
           layer.is().LineOf(layer.SectionIs(section(piece)).first_path),
           absl::StrFormat("this object is printed before one that it touches, which comes before "
                           "it in the original, with line %d",
                           layer.was().LineOf(other.path))});
      return false;
    });
    if (found) return;
  }
}

}  // namespace

void CheckOrder(const LayerPair& layer, const RuleContext& context, LayerFindings& findings) {
  OrderKeeper keeper(layer, context, findings);
  for (size_t k = 0; k < layer.section_count(); ++k) keeper.Check(k);
  CheckMovedObjects(layer, findings);
}

}  // namespace traverse::gcode
