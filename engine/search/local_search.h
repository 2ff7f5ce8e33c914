// Local search over order, entry and direction together.
//
// A queue holds the leaves whose surroundings changed (don't-look bits, Bentley 1992). For each
// leaf the search chooses the entry again and then tries 3-opt moves at its two edges, or at those
// that changed (three_opt.h), each with new entries at the cuts (move_evaluator.h). It applies the
// first move that helps. If none does, it applies the most promising one on trial and searches on
// from there, as in Lin-Kernighan, to some depth. Any plan, any cost: the plan decides which moves
// exist.

#ifndef TRAVERSE_ENGINE_SEARCH_LOCAL_SEARCH_H_
#define TRAVERSE_ENGINE_SEARCH_LOCAL_SEARCH_H_

#include <cstddef>
#include <limits>
#include <vector>

#include "engine/base/budget.h"
#include "engine/search/bookkeeping/leaf_queue.h"
#include "engine/search/bookkeeping/rejected_moves.h"
#include "engine/search/move_evaluator.h"
#include "engine/search/search_state.h"
#include "engine/search/three_opt.h"

namespace traverse {

struct LocalSearchOptions {
  ThreeOptOptions three_opt;
  int depth = 2;  // moves in a row that one improvement may take; 1: no trials

  // Whether moves are tried at both edges of a leaf, or only at those that changed.
  bool both_edges = true;
};

class LocalSearch {
 public:
  // The arguments must outlive the search.
  LocalSearch(SearchState& state, const NeighborLists& neighbors,
              const LocalSearchOptions& options);

  // Changes LocalSearchOptions::depth.
  void set_depth(int depth) { options_.depth = depth; }

  // Notes that the surroundings of `leaf`, or of all leaves, changed.
  void Push(int leaf) { queue_.Push(leaf); }
  void PushAll();

  // Has `leaf` looked at, after those that wait already and before others, for the changes noted
  // until then.
  void Queue(int leaf) { queue_.Enqueue(leaf); }

  // Notes that the move from `position` to the next one changed.
  void PushMove(int position) {
    queue_.PushPair(state_.leaf_at(position), state_.leaf_at(position + 1));
  }

  // Improves the route until the queue is empty or the budget has run out. Returns the change of
  // cost, which is 0 or negative. Allocates nothing. `owed`: how much the route costs more than one
  // that this search could not improve. It also ends once it has gained just that: then it has
  // nearly always come back to that route, where it would find nothing.
  double Run(Budget& budget, double owed = std::numeric_limits<double>::infinity());

  // Chooses the entries of the visits at [first, last] again, exactly for up to two at a time.
  // Returns the change of cost.
  double ChooseEntries(int first, int last);

 private:
  // Entries of two visits, and what the three moves around them cost.
  struct Pair {
    int a;
    int b;
    double cost;
  };

  double Improve(int leaf);
  double ImproveEdge(int t1, bool forward);
  double TryFound(double debt);
  double Do(const SegmentMove& move);
  double ChooseEntry(int position);
  double ChoosePair(int position);
  int BestAfter(int position, Point from) const;
  void ChooseContours(int position, Pair& best);
  void TryPair(int position, int a, int b, Pair& best) const;
  void ApplyTrial(const SegmentMove& move);

  SearchState& state_;
  LocalSearchOptions options_;
  ThreeOpt three_opt_;
  MoveEvaluator evaluator_;
  RejectedMoves rejected_;

  LeafQueue queue_;
  std::vector<int> touched_;  // by the moves on trial
  std::vector<float> tails_;  // scratch of ChooseContours
  std::vector<float> bounds_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_LOCAL_SEARCH_H_
