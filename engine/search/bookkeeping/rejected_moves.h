// The moves that were evaluated in vain since the route last changed.
//
// A search finds the same move from each of its cuts, and evaluates most of them in vain. Looking a
// move up takes little of the time of its evaluation.

#ifndef TRAVERSE_ENGINE_SEARCH_BOOKKEEPING_REJECTED_MOVES_H_
#define TRAVERSE_ENGINE_SEARCH_BOOKKEEPING_REJECTED_MOVES_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/search/segment_move.h"

namespace traverse {

// A table of fixed size: what was added last replaces others.
class RejectedMoves {
 public:
  // Whether `move` was added for this route (SearchState::route_number()).
  bool Contains(const SegmentMove& move, uint64_t route) const {
    const Entry& entry = entries_[Place(move)];
    return entry.route == route && entry.move == move;
  }

  void Add(const SegmentMove& move, uint64_t route) { entries_[Place(move)] = {route, move}; }

 private:
  struct Entry {
    uint64_t route = 0;
    SegmentMove move;
  };

  static constexpr size_t kEntries = 512;

  static size_t Place(const SegmentMove& move) {
    const uint32_t mixed = static_cast<uint32_t>(move.first) * 0x9E3779B1u +
                           static_cast<uint32_t>(move.middle) * 0x85EBCA77u +
                           static_cast<uint32_t>(move.last) * 0xC2B2AE3Du +
                           static_cast<uint32_t>(move.kind) * 0x27D4EB2Fu;
    return (mixed ^ mixed >> 15) % kEntries;
  }

  std::array<Entry, kEntries> entries_{};
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_BOOKKEEPING_REJECTED_MOVES_H_
