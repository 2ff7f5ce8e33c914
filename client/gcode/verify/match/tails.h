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
  Tails(const LayerPair& layer, bool original, bool any_speed = false) {
    const TraceChunk& chunk = original ? layer.was() : layer.is();
    const uint32_t first = original ? layer.first_path_was() : layer.first_path_is();
    const uint32_t end = original ? layer.end_path_was() : layer.end_path_is();
    first_link_ = first;
    moves_.assign(end - first + 1, 0);
    // The travel to the layer begins with moves along the last path of the layer before.
    if (first > 0) {
      std::vector<Piece> pieces;
      AppendPieces(chunk, first - 1, pieces);
      moves_[0] = LayerPair::TailMoves(chunk, first - 1, pieces, any_speed);
    }
    if (original) {
      for (uint32_t path = first; path < end; ++path) {
        moves_[path + 1 - first] =
            LayerPair::TailMoves(chunk, path, layer.PiecesOf(path), any_speed);
      }
    } else {
      for (const Visit& visit : layer.visits()) {
        moves_[visit.last_path + 1 - first] =
            LayerPair::TailMoves(chunk, visit.last_path, layer.PiecesOf(visit.path), any_speed);
      }
    }
  }

  // How many moves at the beginning of the link are not travel.
  uint32_t At(uint32_t link) const {
    if (link < first_link_ || link - first_link_ >= moves_.size()) return 0;
    return moves_[link - first_link_];
  }

 private:
  uint32_t first_link_ = 0;
  std::vector<uint32_t> moves_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TAILS_H_
