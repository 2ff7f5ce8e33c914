// Generalised subtours as inequalities with multipliers (vertex_bound.h).
//
//   S: points of several ends        x(moves within S) <= points of S that are visited - 1
//                                                      if S has all points of some end, else
//                                    x(moves within S) <= points of S that are visited - y_p
//                                                      for any p in S
//
// The moves that a route makes within S are parts of a path through the points of S that it visits
// (Fischetti, Salazar and Toth 1997). An end that has all its points in S counts as one visited.

#ifndef TRAVERSE_ENGINE_PROOF_BOUNDS_SUBTOUR_SETS_H_
#define TRAVERSE_ENGINE_PROOF_BOUNDS_SUBTOUR_SETS_H_

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "engine/proof/bounds/near_moves.h"

namespace traverse {

// How much of each move and point solutions had, on a weighted average.
struct AverageSolution {
  std::vector<double> moves;   // [move]
  std::vector<double> points;  // [point] visited
};

class SubtourSets {
 public:
  // `moves` outlives this.
  explicit SubtourSets(const NearMoves& moves) : moves_(moves) {}

  size_t size() const { return sets_.size(); }

  // Takes the set of `points`, each once, if it is new and `average` violates it by `least` or
  // more; with multiplier 0. Whether it was taken.
  bool Add(std::vector<int> points, const AverageSolution& average, double least);

  // Takes the sets of one point and all points of another end, for all moves of `group` between
  // ends of which the point's has several; with multiplier 0. Nothing may have been known of them.
  void AddNear(const NearMoves::Group& group);

  // Looks for moves within the sets among those that came in since the last call.
  void AddNewMoves();

  // What the multipliers add to each move's cost, and what they pay back for visiting a point.
  // Returns the constant that is left.
  double Weigh(std::vector<double>& penalties, std::vector<double>& paid_back) const;

  // Puts a solution, its moves and the points it visits, into the directions, with `weight` against
  // that of those before.
  void Take(const std::vector<size_t>& moves, const std::vector<int>& points, double weight);

  // Square of the length of the directions, but for those that would make a multiplier negative.
  double SquareOfDirection() const;

  // Moves all multipliers along the directions.
  void Step(double length);

  // The multipliers at hand are those of the best bound; and back to these.
  void Keep();
  void GoBack();

  // Lets sets go that had no multiplier at several calls.
  void DropIdle();

  // An upper bound of what the multipliers add up to in Weigh.
  double Scale() const;

 private:
  struct Set {
    std::vector<int> points;      // ascending
    std::vector<size_t> within;   // moves
    std::vector<int> subtracted;  // points whose visits count on the other side
    double constant = 0;          // x(within) - y(subtracted) <= constant
    double multiplier = 0;
    double best_multiplier = 0;
    double direction = 0;
    int idle = 0;
  };

  // Lists of sets, one behind the other.
  struct Lists {
    std::vector<uint32_t> begin;  // [of]; one more
    std::vector<uint32_t> sets;
  };

  void FindMoves(Set& set, size_t first_move) const;
  void ListSets();
  template <typename Of>
  Lists ListsOf(size_t count, const Of& of) const;

  const NearMoves& moves_;
  std::vector<Set> sets_;
  std::set<std::vector<int>> known_;  // their points
  size_t moves_seen_ = 0;
  bool has_lists_ = false;
  Lists of_moves_;   // [move] sets that it is within
  Lists of_points_;  // [point] sets that subtract it
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_BOUNDS_SUBTOUR_SETS_H_
