// Local search over order, entry and direction together.
//
// A queue holds the leaves whose surroundings changed (don't-look bits, Bentley 1992). For each,
// its own entry is chosen again, then 3-opt moves at its two edges are tried (three_opt.h), each
// with new entries at the cuts (move_evaluator.h); the first that helps is done. If none does, the
// most promising one is done on trial, and the search goes on from there, as in Lin-Kernighan, to
// some depth. Any plan, any cost: the plan decides which moves there are.

#ifndef TRAVERSE_ENGINE_SEARCH_LOCAL_SEARCH_H_
#define TRAVERSE_ENGINE_SEARCH_LOCAL_SEARCH_H_

#include <cstddef>
#include <vector>

#include "engine/base/budget.h"
#include "engine/search/move_evaluator.h"
#include "engine/search/search_state.h"
#include "engine/search/three_opt.h"

namespace traverse {

struct LocalSearchOptions {
  ThreeOptOptions three_opt;
  int depth = 2;  // moves in a row that one improvement may take; 1: no trials
};

class LocalSearch {
 public:
  // The arguments outlive the search.
  LocalSearch(SearchState& state, const NeighborLists& neighbors,
              const LocalSearchOptions& options);

  // Changes LocalSearchOptions::depth.
  void set_depth(int depth) { options_.depth = depth; }

  // Notes that the surroundings of `leaf`, or of all, changed.
  void Push(int leaf);
  void PushAll();

  // Improves the route until the queue is empty or the budget has run out; returns the change of
  // cost, which is 0 or negative. Allocates nothing.
  double Run(Budget& budget);

  // Chooses the entries of the visits at [first, last] again, exactly for up to two of them at a
  // time. Returns the change of cost.
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
  int Pop();

  SearchState& state_;
  LocalSearchOptions options_;
  ThreeOpt three_opt_;
  MoveEvaluator evaluator_;

  // A ring of the leaves to look at.
  std::vector<int> queue_;
  std::vector<char> queued_;  // [leaf]
  size_t head_ = 0;
  size_t size_ = 0;

  std::vector<int> touched_;  // by the moves on trial
  std::vector<float> tails_;  // scratch of ChooseContours
  std::vector<float> bounds_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_LOCAL_SEARCH_H_
