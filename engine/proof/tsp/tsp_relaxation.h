// The linear programme of a path TSP (path_tsp.h) with the cuts found so far.

#ifndef TRAVERSE_ENGINE_PROOF_TSP_TSP_RELAXATION_H_
#define TRAVERSE_ENGINE_PROOF_TSP_TSP_RELAXATION_H_

#include <utility>
#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/programs/linear_program.h"
#include "engine/proof/tsp/path_tsp.h"
#include "engine/proof/tsp/tsp_cuts.h"
#include "engine/proof/tsp/tsp_nodes.h"

namespace traverse {

class TspRelaxation {
 public:
  using Move = TspMove;

  explicit TspRelaxation(const PathTsp& problem);

  const TspNodes& nodes() const { return nodes_; }

  // Moves from the start to a port with cost kUnreached get the cost `forbidden` instead.
  void SetStart(const std::vector<double>& start, double forbidden);

  double MoveCost(const Move& move) const;

  // Adds the moves that are not in the programme yet.
  void AddMoves(const std::vector<Move>& moves);

  // The next functions look at all moves; their answers are worthless if the budget ends.

  // Adds moves with negative reduced cost, the lowest first. The sum of all negative reduced costs
  // of moves outside the programme goes to `missing`. Returns how many were added.
  int Price(int most, double& missing, Budget& budget);

  // The same for an infeasible programme: adds moves that may make it feasible, those first that do
  // the most for that. Returns how many; 0 if it is infeasible with all moves that are not
  // excluded; -1 if that is not sure.
  int PriceInfeasible(int most, Budget& budget);

  // Excludes ports and moves whose reduced cost is above `gap`: no path that costs less than the
  // last bound plus `gap` uses them.
  void LeaveOutDear(double gap, Budget& budget);

  // Allows all ports and moves again, and holds no pairs.
  void AllowAll();

  // What is 0 or 1 in every path, for branching: columns, which are of ports and moves, and whether
  // two items follow each other. That is a sum of moves, which has a row while it is held.
  int column_count() const { return lp_.column_count(); }
  void Fix(int column, bool in) { lp_.SetColumnBounds(column, in ? 1 : 0, in ? 1 : 0); }
  void Free(int column) { lp_.SetColumnBounds(column, 0, 1); }

  struct ItemPair {
    int first = 0;
    int second = 0;
    bool operator==(const ItemPair&) const = default;
  };
  // The pairs whose items partly follow each other in the last solution, by more than one move, and
  // how much of each other they are.
  std::vector<std::pair<ItemPair, double>> DividedPairs() const;
  // Holds these pairs, and no others.
  void HoldPairs(const std::vector<ItemPair>& pairs);
  // REQUIRES: the pair is held.
  void Fix(const ItemPair& pair, bool in);
  // A pair that is not held is free already.
  void Free(const ItemPair& pair);

  // Adds about `most` cuts that the last solution violates; returns how many.
  int Separate(double violation, int most, Budget& budget);

  // Deletes cuts that have not been tight for a while.
  void DropIdleCuts();

  // The path of the last solution if it is a path, else empty.
  std::vector<int> IntegralPath() const;

  LinearProgram& lp() { return lp_; }
  int total_cuts() const { return total_cuts_; }

 private:
  struct RowOfCut {
    TspCut cut;
    int row = 0;
    int idle = 0;  // rounds in which it was not tight
  };

  struct RowOfPair {
    ItemPair pair;
    int row = 0;
  };

  void AddRowsOfNodes();
  ItemPair PairOf(const Move& move) const;
  std::vector<RowOfPair>::const_iterator Held(const ItemPair& pair) const;
  void DeleteRows(const std::vector<int>& rows);
  int ColumnOf(int move) const { return first_move_ + move; }
  int move_count() const { return static_cast<int>(moves_.size()); }
  const Move& move(int index) const { return moves_[static_cast<size_t>(index)]; }
  LinearProgram::Entries EntriesOf(const Move& move) const;
  bool Has(const Move& move) const { return has_[Key(move)] != 0; }
  bool IsAllowed(const Move& move) const {
    return is_dear_[Key(move)] == 0 && left_out_[static_cast<size_t>(move.a)] == 0 &&
           left_out_[static_cast<size_t>(move.b)] == 0;
  }
  size_t Key(const Move& move) const {
    return static_cast<size_t>(move.a) * static_cast<size_t>(nodes_.count()) +
           static_cast<size_t>(move.b);
  }
  std::vector<double> Duals() const;
  void AddLowest(std::vector<std::pair<double, Move>>& reduced, int most);
  template <typename Cost, typename Visit>
  void ForEachCheapMove(const std::vector<double>& duals, const Cost& cost, double most,
                        Budget& budget, const Visit& visit) const;
  TspSolution Solution() const;
  LinearProgram::Row RowOf(const TspCut& cut) const;

  const PathTsp& problem_;
  const TspNodes nodes_;
  std::vector<double> start_;  // [port]
  LinearProgram lp_;  // rows: nodes, items with a choice, cuts and pairs; columns: ports, moves
  std::vector<int> port_column_;  // [port] -1 without a choice
  int first_move_ = 0;            // column
  std::vector<char> left_out_;    // [node] by LeaveOutDear: ports that no better path visits
  std::vector<Move> moves_;       // [column - first_move_]
  std::vector<char> has_;         // [Key(move)]
  std::vector<char> is_dear_;     // [Key(move)] whether it is excluded
  std::vector<RowOfCut> cuts_;
  std::vector<RowOfPair> pairs_;
  int total_cuts_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TSP_TSP_RELAXATION_H_
