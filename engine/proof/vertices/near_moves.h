// The places of a plan's ends, and those moves between them that an ascent looks at
// (vertex_bound.h).

#ifndef TRAVERSE_ENGINE_PROOF_VERTICES_NEAR_MOVES_H_
#define TRAVERSE_ENGINE_PROOF_VERTICES_NEAR_MOVES_H_

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/cost/travel_cost.h"
#include "engine/proof/trees/end_graph.h"
#include "engine/proof/vertices/places.h"

namespace traverse {

// What is called a point here is a place (places.h): one point of an end, or neighboring ones taken
// together. Moves are numbered in the order in which they came in, and none goes out again.
class NearMoves {
 public:
  struct Move {
    int points[2] = {};
    double cost = 0;
  };

  // The moves between two ends, in a row.
  struct Group {
    int junction = 0;
    int ends[2] = {};
    int sides[2] = {};  // among those of all junctions
    size_t begin = 0;   // moves, sorted by the first point, then by the second
    size_t end = 0;
    size_t line = 0;  // the first of its lines
  };

  // At most so many places of an end to begin with. Both other arguments outlive this.
  NearMoves(const EndGraph& graph, const TravelCost& cost, size_t most_of_end);

  const Places& places() const { return places_; }
  int point_count() const { return places_.count(); }
  int side_count() const { return first_side_.back(); }
  int end_of(int point) const { return places_.end_of(point); }

  // The points of `end` are [first(end), first(end + 1)).
  int first(int end) const { return places_.first(end); }
  int size(int end) const { return places_.size(end); }

  // The first side of `junction` among those of all.
  int first_side(int junction) const { return first_side_[static_cast<size_t>(junction)]; }

  // The move between two points costs no less.
  double Cost(int a, int b) const { return cost_.OfLength(places_.LeastDistance(a, b)); }

  // A line has the moves of a group at one point. Those of a group are numbered in a row: of the
  // points of the one end, then of the other.
  size_t line_count() const { return line_count_; }
  size_t LineOf(const Group& group, int point) const {
    const int end = end_of(point);
    const int before = end == group.ends[0] ? 0 : size(group.ends[0]);
    return group.line + static_cast<size_t>(before + point - first(end));
  }

  // Brings all moves between two members in, as one group, unless they are.
  void AddPair(int junction, const Junction::Member& a, const Junction::Member& b);

  // Splits points, as Places::Split does, and so their moves. Returns what became of the points;
  // `parents` becomes [move] what it is a part of.
  std::vector<int> Split(const std::vector<char>& marked, std::vector<size_t>& parents);

  const std::vector<Move>& moves() const { return moves_; }
  const std::vector<Group>& groups() const { return groups_; }

  // The group between two ends; null if their moves are not in. It may move when pairs come in.
  const Group* Find(int a, int b) const;

  // The move between two points. REQUIRES: it is in `group`.
  size_t IndexOf(const Group& group, int a, int b) const {
    if (group.ends[0] != end_of(a)) std::swap(a, b);
    const int from = a - first(end_of(a));
    const int to = b - first(end_of(b));
    const size_t index = group.begin + static_cast<size_t>(from * size(end_of(b)) + to);
    assert(index < group.end && moves_[index].points[0] == a && moves_[index].points[1] == b);
    return index;
  }

 private:
  const TravelCost& cost_;
  Places places_;
  std::vector<int> first_side_;  // [junction]; one more
  std::vector<Move> moves_;
  std::vector<Group> groups_;
  size_t line_count_ = 0;
  std::vector<std::vector<std::pair<int, size_t>>> groups_of_;  // [end] other end, group
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_VERTICES_NEAR_MOVES_H_
