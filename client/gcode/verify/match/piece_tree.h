// Finds straight pieces of paths by position.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PIECE_TREE_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PIECE_TREE_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "client/gcode/verify/match/plane.h"

namespace traverse::gcode {

// Boxes in boxes: each holds half of what the one around it holds, so neither what lies far away
// nor a crowd somewhere makes the others coarse. Long pieces are entered in parts, else the box of
// a diagonal would be the whole layer. Built in O(n log n); memory: some hundred bytes per piece,
// and some megabytes.
class PieceTree {
 public:
  explicit PieceTree(std::vector<Piece> pieces = {});

  const std::vector<Piece>& pieces() const { return pieces_; }
  bool empty() const { return pieces_.empty(); }

  // So many pairs of them are looked at, at most: far more than a layer that can be printed needs.
  size_t most_looks() const { return 100'000 + 1000 * pieces_.size(); }

  // Calls visit(index) for all pieces that come within `reach` of the straight line from `a` to
  // `b`, and for some others; for some more than once. Stops when visit returns false.
  template <typename Visit>
  void ForEachNear(Point a, Point b, double reach, Visit visit) const {
    ForEachLeafNear(
        a, b, reach, [](uint32_t) { return true; },
        [&](uint32_t leaf) {
          const absl::Span<const uint32_t> indices = IndicesOf(leaf);
          return std::ranges::all_of(indices, visit);
        });
  }

  // Whether found(piece) is true for one of those.
  template <typename Found>
  bool AnyNear(Point a, Point b, double reach, Found found) const {
    bool any = false;
    ForEachNear(a, b, reach, [&](uint32_t i) {
      any = found(pieces_[i]);
      return !any;
    });
    return any;
  }

  // Whether counts(piece) is true for one that crosses the line (PiecesCross), or the line passes
  // so many that it takes no more time to look: no travel of a print passes as many.
  static constexpr uint32_t kMostPassed = 5000;
  template <typename Counts>
  bool AnyAcross(Point a, Point b, Counts counts) const {
    constexpr double kRoundingMm = 1e-6;
    uint32_t passed = 0;
    return AnyNear(a, b, kRoundingMm, [&](const Piece& piece) {
      return (counts(piece) && PiecesCross(a, b, piece.a, piece.b)) || ++passed == kMostPassed;
    });
  }

  // Nodes are numbered from 0, each before those within it. One that has others within it has two:
  // `node` + 1, and SecondOf(node).
  uint32_t node_count() const { return static_cast<uint32_t>(nodes_.size()); }
  bool IsLeaf(uint32_t node) const { return nodes_[node].behind == node + 1; }
  uint32_t SecondOf(uint32_t node) const { return nodes_[node + 1].behind; }

  // Of the pieces within a node, those of its first leaf.
  absl::Span<const uint32_t> IndicesOf(uint32_t node) const {
    return absl::MakeSpan(entries_).subspan(nodes_[node].first, nodes_[node].count);
  }

  // Calls visit(leaf) for the leaves within reach, as ForEachNear does for pieces, but for those
  // within a node for which enter(node) is false.
  template <typename Enter, typename Visit>
  void ForEachLeafNear(Point a, Point b, double reach, Enter enter, Visit visit) const {
    const Line line(a, b, reach);
    for (uint32_t node = 0; node < nodes_.size();) {
      const bool inside = line.Meets(nodes_[node].box) && enter(node);
      if (inside && IsLeaf(node) && !visit(node)) return;
      node = inside ? node + 1 : nodes_[node].behind;
    }
  }

 private:
  struct Box {
    Point low;
    Point high;
  };

  struct Node {
    Box box;
    uint32_t behind = 0;  // the first node that is not within this one
    uint32_t first = 0;   // in entries_, of its first leaf
    uint32_t count = 0;
  };

  // A line as wide as twice `reach`.
  class Line {
   public:
    Line(Point a, Point b, double reach)
        : middle_{(a.x + b.x) / 2, (a.y + b.y) / 2},
          half_{(b.x - a.x) / 2, (b.y - a.y) / 2},
          reach_(reach) {}

    // False if the line and the box, widened by `reach`, lie apart along x, along y, or across the
    // line.
    bool Meets(const Box& box) const {
      const double wide = (box.high.x - box.low.x) / 2 + reach_;
      const double high = (box.high.y - box.low.y) / 2 + reach_;
      const double dx = (box.high.x + box.low.x) / 2 - middle_.x;
      const double dy = (box.high.y + box.low.y) / 2 - middle_.y;
      const double along_x = std::abs(half_.x);
      const double along_y = std::abs(half_.y);
      if (std::abs(dx) > wide + along_x || std::abs(dy) > high + along_y) return false;
      return !(std::abs(half_.x * dy - half_.y * dx) > along_y * wide + along_x * high);
    }

   private:
    Point middle_;
    Point half_;
    double reach_;
  };

  struct Part {
    Point a;
    Point b;
    uint32_t piece;
  };

  std::vector<Part> PartsOfPieces() const;
  void Build(absl::Span<Part> parts);

  std::vector<Piece> pieces_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> entries_;  // indices of pieces
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PIECE_TREE_H_
