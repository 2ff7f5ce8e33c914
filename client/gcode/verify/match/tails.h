// Moves along the end of a path without filament, which are not travel.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TAILS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TAILS_H_

#include <cstdint>
#include <vector>

#include "client/gcode/verify/match/layer_pair.h"

namespace traverse::gcode {

// The tails of the paths of one layer, in the original or in the other file.
class Tails {
 public:
  // With `any_speed`: only moves that lie on the path and do not go straight on beyond its end.
  Tails(const LayerPair& layer, bool original, bool any_speed = false)
      : first_link_(layer.Side(original).first_path) {
    const LayerSide& side = layer.Side(original);
    moves_.assign(side.end_path - first_link_ + 1, 0);
    const auto note = [&](uint32_t path, absl::Span<const Piece> pieces) {
      moves_[path + 1 - first_link_] = LayerPair::TailMoves(side.chunk, path, pieces, any_speed);
    };
    // The travel to the layer begins with moves along the last path of the layer before.
    if (first_link_ > 0) {
      std::vector<Piece> pieces;
      AppendPieces(side.chunk, first_link_ - 1, pieces);
      note(first_link_ - 1, pieces);
    }
    for (const Visit& visit : layer.visits()) {
      if (!original) note(visit.last_path, layer.PiecesOf(visit.path));
    }
    for (uint32_t path = first_link_; original && path < side.end_path; ++path) {
      note(path, layer.PiecesOf(path));
    }
  }

  // How many moves at the beginning of the link are not travel.
  uint32_t At(uint32_t link) const {
    if (link < first_link_ || link - first_link_ >= moves_.size()) return 0;
    return moves_[link - first_link_];
  }

 private:
  const uint32_t first_link_;
  std::vector<uint32_t> moves_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TAILS_H_
