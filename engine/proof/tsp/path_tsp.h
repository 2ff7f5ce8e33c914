// Shortest paths through items, proven by branch and cut.
//
//   start -> p ==== p' -> q ==== q' -> r -> ... -> finish        p, p': the ends of one item
//
// An item is entered at one of its two ends and left at the other, or is entered and left at the
// same one of its ports, of which it may have many: a generalised travelling salesman path. Costs
// are symmetric. As an integer programme, with x_e for each undirected move e, y_p for each port of
// an item that has a choice of them, the start and the finish joined by a fixed edge like the two
// ends of an item:
//
//   min sum c_e x_e,   x(moves of a node) = 1 for an end, 2 for a lone port, 2 y_p for a choice
//   sum of y_p over an item = 1
//   x(moves within S) <= ports of S that are visited - 1       S a set of ports with all of an item
//   x(moves within S) <= ports of S that are visited - y_p     p in S, S any set (subtours)
//   x(moves out of H, not in F) + sum over F (1 - x_e) >= 1    F odd, fixed edges included
//   (blossoms; all moves between two items with a choice are one edge)
//
// Dantzig, Fulkerson and Johnson (1954); Padberg and Rinaldi (1991); of items with a choice
// Fischetti, Salazar and Toth (1997), whose generalised subtours these are. Moves come in by
// reduced cost, at each node, and where a programme has no solution, by what they do against that;
// at the root those that no better path can use are left out for good; strong branching on moves
// and on whether two items follow each other, depth first. Bounds are safe: computed from the duals
// without trust in the solver's tolerances.

#ifndef TRAVERSE_ENGINE_PROOF_TSP_PATH_TSP_H_
#define TRAVERSE_ENGINE_PROOF_TSP_PATH_TSP_H_

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "engine/base/budget.h"

namespace traverse {

struct PathTsp {
  int ports = 0;
  std::vector<int> item;       // [port] from 0; the ports of an item are consecutive
  std::vector<int> mate;       // [port] where its item is left if it is entered here
  std::vector<double> cost;    // [p * ports + q] of moves, symmetric, not negative
  std::vector<double> finish;  // [port] cost of ending here

  double Cost(int p, int q) const {
    return cost[static_cast<size_t>(p) * static_cast<size_t>(ports) + static_cast<size_t>(q)];
  }
};

// Solves one problem for several start costs and keeps what it learns.
class PathTspSolver {
 public:
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();

  struct Result {
    // No path costs less; at least `cutoff` if no path costs less than that.
    double lower_bound = 0;
    // Where a path cheaper than `cutoff` enters each item, in order; empty if none was found.
    std::vector<int> path;
    double cost = 0;
    bool complete = false;  // lower_bound is the least cost, or at least `cutoff`
  };

  // Programmes of a node, but for the root's, that take more iterations of the simplex method leave
  // it open, as do those that rounding spoils. It is tried once more when all others are done.
  static constexpr int kMostIterations = 100'000;

  // REQUIRES: there are at least two items.
  explicit PathTspSolver(PathTsp problem, int most_iterations = kMostIterations);
  ~PathTspSolver();

  // `start`: cost of beginning at each port, kUnreached if that is not possible. `known`: a path in
  // the form of Result::path to start from.
  Result Solve(const std::vector<double>& start, double cutoff, const std::vector<int>& known,
               Budget& budget);

  // A lower bound without branching, at most `cutoff`: much quicker than Solve. Ends when the
  // programmes have taken `most_work` (LinearProgram::work).
  double RootBound(const std::vector<double>& start, double cutoff, Budget& budget,
                   double most_work = kUnlimited);

  int nodes() const;  // of all searches so far
  int cuts() const;

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TSP_PATH_TSP_H_
