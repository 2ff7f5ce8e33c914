#include "client/gcode/verify/match/piece_tree.h"

#include <cstddef>
#include <utility>

namespace traverse::gcode {
namespace {

constexpr size_t kPartsOfLeaf = 8;
constexpr double kPartMm = 2;
constexpr double kPartsOfPiece = 2;  // on the average, at most, and some more
constexpr double kPartsAlways = 1 << 16;

}  // namespace

PieceTree::PieceTree(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  if (pieces_.empty()) return;
  std::vector<Part> parts = PartsOfPieces();
  entries_.reserve(parts.size());
  nodes_.reserve(parts.size() / 2 + 1);
  Build(absl::MakeSpan(parts));
}

std::vector<PieceTree::Part> PieceTree::PartsOfPieces() const {
  const double most = kPartsOfPiece * static_cast<double>(pieces_.size()) + kPartsAlways;
  const double part_mm = std::max(kPartMm, LengthOf(pieces_) / most);
  std::vector<Part> parts;
  for (uint32_t i = 0; i < pieces_.size(); ++i) {
    const auto& [a, b, path] = pieces_[i];
    const double count = std::clamp(std::ceil(Distance(a, b) / part_mm), 1.0, most);
    Point at = a;
    for (double k = 1; k <= count; ++k) {
      const Point next = k < count ? Between(a, b, k / count) : b;
      parts.push_back({at, next, i});
      at = next;
    }
  }
  return parts;
}

// A node for `parts` with all that are within it.
void PieceTree::Build(absl::Span<Part> parts) {
  const size_t node = nodes_.size();
  Box box{parts[0].a, parts[0].a};
  for (const Part& part : parts) {
    for (const Point p : {part.a, part.b}) {
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    }
  }
  nodes_.push_back({box, 0, static_cast<uint32_t>(entries_.size()), 0});
  if (parts.size() <= kPartsOfLeaf) {
    for (const Part& part : parts) entries_.push_back(part.piece);
    const auto begin = entries_.begin() + nodes_[node].first;
    std::sort(begin, entries_.end());
    entries_.erase(std::unique(begin, entries_.end()), entries_.end());
  } else {
    const bool across = box.high.x - box.low.x > box.high.y - box.low.y;
    const auto before = [across](const Part& one, const Part& two) {
      return across ? one.a.x + one.b.x < two.a.x + two.b.x : one.a.y + one.b.y < two.a.y + two.b.y;
    };
    const size_t half = parts.size() / 2;
    std::nth_element(parts.begin(), parts.begin() + half, parts.end(), before);
    Build(parts.first(half));
    Build(parts.subspan(half));
  }
  nodes_[node].behind = static_cast<uint32_t>(nodes_.size());
  nodes_[node].count = IsLeaf(static_cast<uint32_t>(node))
                           ? static_cast<uint32_t>(entries_.size()) - nodes_[node].first
                           : nodes_[node + 1].count;
}

}  // namespace traverse::gcode
