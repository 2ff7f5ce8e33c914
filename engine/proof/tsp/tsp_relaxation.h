// The linear programme of a path TSP (path_tsp.h) with the cuts found so far.

#ifndef TRAVERSE_ENGINE_PROOF_TSP_TSP_RELAXATION_H_
#define TRAVERSE_ENGINE_PROOF_TSP_TSP_RELAXATION_H_

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

  // Moves from the start to a port with cost kUnreached cost `forbidden` instead.
  void SetStart(const std::vector<double>& start, double forbidden);

  double MoveCost(const Move& move) const;

  // Brings moves in, but those that are in.
  void AddMoves(const std::vector<Move>& moves);

  // What follows looks at all moves; where the budget ends it, what it says is worth nothing.

  // Brings in moves with negative reduced cost, the lowest first. The sum of all negative reduced
  // costs of moves that are not in the programme goes to `missing`. Returns how many were added.
  int Price(int most, double& missing, Budget& budget);

  // Leaves out ports and moves whose reduced cost is above `gap`: no path has them that costs less
  // than the last bound and `gap` together.
  void LeaveOutDear(double gap, Budget& budget);

  // Brings in all moves that were not left out, so that none has to be priced any more. False, with
  // nothing changed, if that would be more than `most`.
  bool Complete(int most);

  // Allows all ports and moves again.
  void AllowAll();

  // Columns, of ports and moves, that are 0 or 1 in every path: what can be branched on.
  int column_count() const { return lp_.column_count(); }
  void Fix(int column, bool in) { lp_.SetColumnBounds(column, in ? 1 : 0, in ? 1 : 0); }
  void Free(int column) { lp_.SetColumnBounds(column, 0, 1); }

  // Adds cuts that the last solution violates, about `most`; returns how many.
  int Separate(double violation, int most, Budget& budget);

  // Deletes cuts that have not been tight for a while.
  void DropIdleCuts();

  // The path of the last solution if that is one, else empty.
  std::vector<int> IntegralPath() const;

  LinearProgram& lp() { return lp_; }
  int total_cuts() const { return total_cuts_; }

 private:
  struct RowOfCut {
    TspCut cut;
    int row = 0;
    int idle = 0;  // rounds without being tight
  };

  void AddRowsOfNodes();
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
  template <typename Visit>
  void ForEachCheapMove(double most, Budget& budget, const Visit& visit) const;
  TspSolution Solution() const;
  LinearProgram::Row RowOf(const TspCut& cut) const;

  const PathTsp& problem_;
  const TspNodes nodes_;
  std::vector<double> start_;     // [port]
  LinearProgram lp_;              // rows: nodes, items with a choice, cuts; columns: ports, moves
  std::vector<int> port_column_;  // [port] -1 without a choice
  int first_move_ = 0;            // column
  std::vector<char> left_out_;    // [node] by LeaveOutDear: ports that no better path visits
  std::vector<Move> moves_;       // [column - first_move_]
  std::vector<char> has_;         // [Key(move)]
  std::vector<char> is_dear_;     // [Key(move)] left out
  std::vector<RowOfCut> cuts_;
  int total_cuts_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TSP_TSP_RELAXATION_H_
