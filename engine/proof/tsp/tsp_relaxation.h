// The linear programme of a path TSP (path_tsp.h) with the cuts found so far.

#ifndef TRAVERSE_ENGINE_PROOF_TSP_TSP_RELAXATION_H_
#define TRAVERSE_ENGINE_PROOF_TSP_TSP_RELAXATION_H_

#include <cstdint>
#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/programs/linear_program.h"
#include "engine/proof/tsp/path_tsp.h"
#include "engine/proof/tsp/support_graph.h"

namespace traverse {

class TspRelaxation {
 public:
  // A move between two nodes, a < b: ports, then the start, then the finish.
  struct Move {
    int a = 0;
    int b = 0;
  };

  explicit TspRelaxation(const PathTsp& problem);

  int start_node() const { return problem_.ports; }
  int finish_node() const { return problem_.ports + 1; }
  int node_count() const { return problem_.ports + 2; }

  // Moves from the start to a port with cost kUnreached cost `forbidden` instead.
  void SetStart(const std::vector<double>& start, double forbidden);

  double MoveCost(const Move& move) const;
  int move_count() const { return static_cast<int>(moves_.size()); }
  const Move& move(int index) const { return moves_[static_cast<size_t>(index)]; }
  void AddMove(const Move& move);

  // Brings in moves with negative reduced cost, the lowest first. The sum of all negative reduced
  // costs of moves that are not in the programme goes to `missing`. Returns how many were added.
  int Price(int most, double& missing);

  // All moves allowed again; then all those out whose reduced cost is above `gap`, and those in
  // that were not yet and are not. After Restrict no move has to be priced. False, with nothing
  // changed, if more than `most_new` would have to come in: the gap is too wide for branching.
  void AllowAll();
  bool Restrict(double gap, int most_new);

  // Adds cuts that the last solution violates, at most `most`; returns how many.
  int Separate(double violation, int most);

  // Deletes cuts that have not been tight for a while.
  void DropIdleCuts();

  // The path of the last solution if that is one, else empty.
  std::vector<int> IntegralPath() const;

  LinearProgram& lp() { return lp_; }
  int total_cuts() const { return total_cuts_; }

 private:
  struct Cut {
    bool is_subtour = false;
    CutSide side;           // [node]
    std::vector<Move> odd;  // of a blossom: the moves in F
    int row = 0;
    int idle = 0;  // rounds without being tight
  };

  double Coefficient(const Cut& cut, const Move& move) const;
  LinearProgram::Entries ColumnOf(const Move& move) const;
  bool Has(const Move& move) const { return has_[Key(move)] != 0; }
  size_t Key(const Move& move) const {
    return static_cast<size_t>(move.a) * static_cast<size_t>(node_count()) +
           static_cast<size_t>(move.b);
  }
  bool IsPossible(int a, int b) const;
  template <typename Visit>
  void ForEachCheapMove(double most, const Visit& visit);

  SupportGraph ItemGraph() const;
  SupportGraph PortGraph(std::vector<int>& move_of_edge) const;
  void AddSubtourCut(const CutSide& items);
  void AddBlossomCut(const CutSide& nodes, const std::vector<Move>& odd);
  void AddCut(Cut cut, double lower, double upper);

  const PathTsp& problem_;
  std::vector<double> start_;  // [port]
  std::vector<int> item_;      // [node] from 1; the start and the finish are 0
  int item_count_ = 1;
  LinearProgram lp_;         // rows: nodes, then cuts; columns: moves
  std::vector<Move> moves_;  // [column]
  std::vector<char> has_;    // [Key(move)]
  std::vector<Cut> cuts_;
  int total_cuts_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TSP_TSP_RELAXATION_H_
