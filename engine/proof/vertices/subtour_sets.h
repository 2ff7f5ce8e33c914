// Generalised subtours as inequalities with multipliers (vertex_bound.h).
//
//   S: points of several ends        x(moves within S) <= points of S that are visited - 1
//                                                      if S has all points of some end, else
//                                    x(moves within S) <= points of S that are visited - y_p
//                                                      for any p in S
//
// The moves that a route makes within S are parts of a path through the points of S that it visits
// (Fischetti, Salazar and Toth 1997). An end that has all its points in S counts as one visited.

#ifndef TRAVERSE_ENGINE_PROOF_VERTICES_SUBTOUR_SETS_H_
#define TRAVERSE_ENGINE_PROOF_VERTICES_SUBTOUR_SETS_H_

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "engine/proof/vertices/near_moves.h"

namespace traverse {

// How much of each move and point solutions had, on a weighted average.
struct AverageSolution {
  std::vector<double> moves;   // [move]
  std::vector<double> points;  // [point] visited
};

// What moves cost because of multipliers: each has that of its group, its two lines (near_moves.h)
// and its own.
struct Penalties {
  std::vector<double> groups, lines, moves;
};

class SubtourSets {
 public:
  // `moves` outlives this.
  explicit SubtourSets(const NearMoves& moves) : moves_(moves) {}

  size_t size() const { return sets_.size(); }

  // Takes the set of `points`, each once, if it is new and `average` violates it by `least` or
  // more; with multiplier 0. Whether it was taken.
  bool Add(std::vector<int> points, const AverageSolution& average, double least);

  // Looks for moves within the sets among those that came in since the last call.
  void AddNewMoves();

  // After points were split (NearMoves::Split): what point p was is [became[p], became[p + 1]). The
  // sets have these points instead.
  void Split(const std::vector<int>& became);

  // What the multipliers add to each move's cost, and what they pay back for visiting a point.
  // Returns the constant that is left.
  double Weigh(Penalties& penalties, std::vector<double>& paid_back) const;

  // Puts a solution, its moves with their groups and the points it visits, into the directions,
  // with `weight` against that of those before.
  struct Taken {
    size_t group = 0;
    size_t move = 0;
  };
  void Take(const std::vector<Taken>& moves, const std::vector<int>& points, double weight);

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
    std::vector<size_t> groups;   // of which all moves are within the set
    std::vector<size_t> lines;    // the same, of other groups
    std::vector<size_t> moves;    // the same, of other lines
    std::vector<int> subtracted;  // points whose visits count on the other side
    double constant = 0;          // x(moves within) - y(subtracted) <= constant
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

  void FindMoves(Set& set, size_t first_group) const;
  double Within(const Set& set, const AverageSolution& average) const;
  void ListSets();
  template <typename Of>
  Lists ListsOf(size_t count, const Of& of) const;

  const NearMoves& moves_;
  std::vector<Set> sets_;
  std::set<std::vector<int>> known_;  // their points
  size_t groups_seen_ = 0;
  bool has_lists_ = false;
  Lists of_groups_;  // [group] sets that it is within
  Lists of_lines_;
  Lists of_moves_;
  Lists of_points_;  // [point] sets that subtract it
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_VERTICES_SUBTOUR_SETS_H_
