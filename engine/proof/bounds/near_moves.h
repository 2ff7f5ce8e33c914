// The points of a plan's ends, and those moves between them that an ascent looks at
// (vertex_bound.h).

#ifndef TRAVERSE_ENGINE_PROOF_BOUNDS_NEAR_MOVES_H_
#define TRAVERSE_ENGINE_PROOF_BOUNDS_NEAR_MOVES_H_

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/cost/travel_cost.h"
#include "engine/proof/bounds/end_graph.h"

namespace traverse {

// Points are numbered through all ends, moves in the order in which they came in. Grows only.
class NearMoves {
 public:
  struct Move {
    int points[2] = {};
    double cost = 0;
  };

  // The moves between two ends, in a row.
  struct Group {
    int sides[2] = {};  // among those of all junctions
    size_t begin = 0;   // moves
    size_t end = 0;
  };

  // Both arguments outlive this.
  NearMoves(const EndGraph& graph, const TravelCost& cost);

  int point_count() const { return static_cast<int>(end_of_.size()); }
  int side_count() const { return first_side_.back(); }
  int end_of(int point) const { return end_of_[static_cast<size_t>(point)]; }

  // The points of `end` are [first(end), first(end + 1)).
  int first(int end) const { return first_[static_cast<size_t>(end)]; }
  int size(int end) const { return first(end + 1) - first(end); }

  // The first side of `junction` among those of all.
  int first_side(int junction) const { return first_side_[static_cast<size_t>(junction)]; }

  // Brings all moves between two members in, as one group, unless they are.
  void AddPair(int junction, const Junction::Member& a, const Junction::Member& b);

  const std::vector<Move>& moves() const { return moves_; }
  const std::vector<Group>& groups() const { return groups_; }

  // The group between two ends; null if their moves are not in. It may move when pairs come in.
  const Group* Find(int a, int b) const;

  // The move between two points. REQUIRES: it is in `group`.
  size_t IndexOf(const Group& group, int a, int b) const {
    if (end_of(moves_[group.begin].points[0]) != end_of(a)) std::swap(a, b);
    const int from = a - first(end_of(a));
    const int to = b - first(end_of(b));
    const size_t index = group.begin + static_cast<size_t>(from * size(end_of(b)) + to);
    assert(index < group.end && moves_[index].points[0] == a && moves_[index].points[1] == b);
    return index;
  }

 private:
  const EndGraph& graph_;
  const TravelCost& cost_;
  std::vector<int> first_;       // [end]; one more
  std::vector<int> end_of_;      // [point]
  std::vector<int> first_side_;  // [junction]; one more
  std::vector<Move> moves_;
  std::vector<Group> groups_;
  std::vector<std::vector<std::pair<int, size_t>>> groups_of_;  // [end] other end, group
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_BOUNDS_NEAR_MOVES_H_
