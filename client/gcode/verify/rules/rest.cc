#include "client/gcode/verify/rules/rest.h"

#include <algorithm>
#include <memory>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "absl/strings/str_format.h"
#include "absl/types/span.h"
#include "client/gcode/verify/match/piece_tree.h"
#include "engine/base/disjoint_sets.h"

namespace traverse::gcode {
namespace {

// A rest may be shorter by this share.
constexpr double kLeastShare = 0.95;

// Rounding of sums of times.
constexpr double kSlackSeconds = 1e-3;

constexpr double kLeastReachMm = 0.52;
constexpr double kMostReachMm = 4;
constexpr double kReachWidths = 1.25;

class IslandFinder {
 public:
  // Filament of `filament_mm`, in diameter.
  IslandFinder(const LayerPair& layer, double height_mm, double filament_mm)
      : layer_(layer),
        first_(layer.first_path_was()),
        apart_(layer.end_path_was() - first_),
        regions_(static_cast<int>(apart_)),
        tree_(layer.pieces()) {
    for (uint32_t path = first_; path < layer.end_path_was(); ++path) {
      reach_.push_back(ReachOf(layer.was().paths[path], height_mm, filament_mm));
    }
  }

  PrintedIslands Find() {
    JoinNear();
    NoteTimes();
    NotePlaces();
    NoteJoined();
    return std::move(found_);
  }

 private:
  static double ReachOf(const TracePath& path, double height_mm, double filament_mm) {
    if (!(path.length_mm > 0) || !(height_mm > 0)) return kLeastReachMm;
    const double area =
        path.filament_mm / path.length_mm * filament_mm * filament_mm * std::numbers::pi / 4;
    return std::clamp(kReachWidths * area / height_mm, kLeastReachMm, kMostReachMm);
  }

  // First the first pieces of all paths, then the second ones: most islands are whole before most
  // pieces are looked at.
  void JoinNear() {
    whole_.resize(tree_.node_count());
    // Where all pieces are of one path, nobody needs to look.
    for (uint32_t node = tree_.node_count(); node-- > 0;) IsWhole(node);
    looks_ = tree_.most_looks();
    std::vector<uint32_t> longer(reach_.size());  // paths with more than `k` pieces
    std::iota(longer.begin(), longer.end(), first_);
    for (uint32_t k = 0; !longer.empty(); ++k) {
      std::erase_if(longer, [&](uint32_t path) { return layer_.PiecesOf(path).size() <= k; });
      for (const uint32_t path : longer) {
        if (layer_.Ended() || apart_ <= 1) return;
        JoinWithNear(layer_.PiecesOf(path)[k]);
        if (looks_ > 0) continue;
        for (int other = 1; other < static_cast<int>(reach_.size()); ++other) {
          regions_.Join(other, 0);
        }
        return;
      }
    }
  }

  // Where crowds of pieces lie in one place, to look at all pairs would take long: then the layer
  // is taken for one island. Pieces beside each other that are of one island are passed by
  // together.
  void JoinWithNear(const Piece& piece) {
    tree_.ForEachLeafNear(
        piece.a, piece.b, reach_[piece.path - first_],
        [&](uint32_t node) {
          return !IsWhole(node) || !regions_.AreJoined(RegionOf(piece), RegionOf(node));
        },
        [&](uint32_t leaf) {
          const absl::Span<const uint32_t> indices = tree_.IndicesOf(leaf);
          for (const uint32_t i : indices) JoinIfNear(piece, tree_.pieces()[i]);
          looks_ -= std::min<uint64_t>(looks_, indices.size() + 1);
          return looks_ > 0;
        });
  }

  int RegionOf(const Piece& piece) const { return static_cast<int>(piece.path - first_); }

  // That of some piece within the node: of all of them, if it is whole.
  int RegionOf(uint32_t node) const { return RegionOf(tree_.pieces()[tree_.IndicesOf(node)[0]]); }

  // True if all pieces within a node are of one region; false also where nobody has looked at one
  // of the nodes within it since that is so.
  bool IsWhole(uint32_t node) {
    if (whole_[node]) return true;
    if (tree_.IsLeaf(node)) {
      const absl::Span<const uint32_t> indices = tree_.IndicesOf(node);
      whole_[node] = std::ranges::all_of(indices, [&](uint32_t i) {
        return regions_.AreJoined(RegionOf(tree_.pieces()[i]), RegionOf(node));
      });
    } else {
      const uint32_t second = tree_.SecondOf(node);
      whole_[node] = whole_[node + 1] && whole_[second] &&
                     regions_.AreJoined(RegionOf(node), RegionOf(second));
    }
    return whole_[node];
  }

  void JoinIfNear(const Piece& piece, const Piece& other) {
    if (regions_.AreJoined(RegionOf(piece), RegionOf(other))) return;
    const double sum = reach_[piece.path - first_] + reach_[other.path - first_];
    const double reach = std::max(sum / 2, kLeastReachMm);
    if (DistanceOfPieces(piece.a, piece.b, other.a, other.b) > reach) return;
    regions_.Join(RegionOf(piece), RegionOf(other));
    --apart_;
  }

  void NoteTimes() {
    const TraceChunk& was = layer_.was();
    const TraceChunk& is = layer_.is();
    for (const int number : regions_.Numbered()) {
      const auto path = static_cast<uint32_t>(island_.size());
      const TracePath& traced = was.paths[first_ + path];
      island_.push_back(static_cast<uint32_t>(number));
      if (island_.back() == found_.islands.size()) found_.islands.emplace_back();
      PrintedIsland& island = found_.islands[island_.back()];
      island.first_path = std::min(island.first_path, path);
      island.last_path = path;
      island.was.Include({traced.begun_seconds, traced.left_seconds, was.LineOf(traced)});
    }
    for (const Visit& visit : layer_.visits()) {
      const TracePath& begins = is.paths[visit.first_path];
      found_.islands[island_[visit.path - first_]].is.Include(
          {begins.begun_seconds, is.paths[visit.last_path].left_seconds, is.LineOf(begins)});
    }
    found_.paths = static_cast<uint32_t>(reach_.size());
  }

  void NotePlaces() {
    IslandMap map(static_cast<uint32_t>(found_.islands.size()));
    for (const Piece& piece : tree_.pieces()) {
      if (layer_.Ended()) return;
      map.AddLine(piece.a.x, piece.a.y, piece.b.x, piece.b.y, island_[piece.path - first_]);
    }
    found_.tree = map.TakeTree();
    found_.cells = map.TakeCells();
  }

  // What counts as one island is begun with the first part of it, and left with the last one.
  void NoteJoined() {
    found_.islands.resize(found_.tree.size());
    for (uint32_t node = 0; node < found_.tree.size(); ++node) {
      const PrintedIsland& part = found_.islands[node];
      PrintedIsland& whole = found_.islands[found_.tree.ParentOf(node)];
      whole.was.Include(part.was);
      whole.is.Include(part.is);
      whole.first_path = std::min(whole.first_path, part.first_path);
      whole.last_path = std::max(whole.last_path, part.last_path);
    }
  }

  const LayerPair& layer_;
  const uint32_t first_;
  uint32_t apart_;  // regions
  DisjointSets regions_;
  const PieceTree tree_;
  std::vector<double> reach_;  // [path of the layer]
  std::vector<bool> whole_;    // [node of tree_] known to be of one region
  uint64_t looks_ = 0;
  std::vector<uint32_t> island_;  // [path of the layer]
  PrintedIslands found_;
};

}  // namespace

PrintedIslands FindPrintedIslands(const LayerPair& layer, double height_mm, double filament_mm) {
  return IslandFinder(layer, height_mm, filament_mm).Find();
}

bool RestWatch::RestsTooShort(const PrintedIsland& below, uint64_t first_path,
                              const PrintedIsland& island) const {
  // Nothing else is printed meanwhile.
  if (first_path + below.last_path + 1 == paths_ + island.first_path) return false;
  const double needed =
      kLeastShare * std::min(island.was.begun - below.was.left, least_seconds_) - kSlackSeconds;
  return island.is.begun - below.is.left < needed;
}

void RestWatch::Take(PrintedIslands layer, int64_t index, std::vector<Finding>& breaks) {
  const auto now = std::make_shared<Below>(
      Below{std::move(layer.islands), std::move(layer.tree), paths_, index});
  std::vector<bool> broken(now->islands.size());
  std::tuple<const Below*, uint32_t, uint32_t> looked_at;
  for (const auto& [cell, number] : layer.cells) {
    const auto found = top_.find(cell);
    if (found == top_.end() || found->second.layer->index == index) continue;
    const Below& under = *found->second.layer;
    const std::tuple pair(&under, found->second.island, number);
    if (pair == looked_at) continue;
    looked_at = pair;
    const auto check = [&](uint32_t one, uint32_t two) {
      const PrintedIsland& below = under.islands[one];
      const PrintedIsland& island = now->islands[two];
      if (broken[two] || !RestsTooShort(below, under.first_path, island)) return;
      broken[two] = true;
      breaks.push_back(
          {VerifyRule::kRest,
           island.was.line,
           {island.is.line, index},
           absl::StrFormat(
               "printed %.1f s after the island below; that rests %.1f s in the original"
               " where %.4g s are enough",
               island.is.begun - below.is.left, island.was.begun - below.was.left,
               least_seconds_)});
    };
    IslandTree::ForEachPair(under.tree, found->second.island, now->tree, number, check);
  }
  for (const auto& [cell, number] : layer.cells) {
    if (top_.size() >= kMostCellsOfPrint && !top_.contains(cell)) continue;
    top_[cell] = {now, number};
  }
  paths_ += layer.paths;
}

}  // namespace traverse::gcode
