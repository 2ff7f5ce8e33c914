// What a segment move is worth if the entries next to it are chosen again.
//
//   ... a - p | B ....... c | q - d ...      the entries of p, c, B's first and q are free, those
//   of
//   ... a - p | c ....... B | q - d ...      their other neighbors (a, d, and inside B) stay
//
// Where entries are many, most good moves look bad with the entries that suited the old neighbors.
// One sweep along each stretch of free visits gives every visit its best entry between the one
// before, already chosen, and the one after, not yet chosen (Karapetyan and Gutin 2011 compare
// such ways for the generalized TSP). O(entries of six visits) a move.

#ifndef TRAVERSE_ENGINE_SEARCH_MOVE_EVALUATOR_H_
#define TRAVERSE_ENGINE_SEARCH_MOVE_EVALUATOR_H_

#include <array>
#include <cstddef>
#include <limits>

#include "engine/search/search_state.h"
#include "engine/search/segment_move.h"

namespace traverse {

class MoveEvaluator {
 public:
  // `state` must outlive the evaluator.
  explicit MoveEvaluator(SearchState& state) : state_(state) {}

  // The change of cost by `move` with new entries; negative is better. Equals a full recomputation
  // after Apply. Stops early once the change reaches `most`, with some value not below `most`. Does
  // not change the route. REQUIRES: the plan allows the move, or it is not applied.
  double Evaluate(const SegmentMove& move, double most = std::numeric_limits<double>::infinity());

  // Applies the move evaluated last, with its entries. REQUIRES: it was not ended early.
  void Apply(const SegmentMove& move);

 private:
  // A visit near a cut, as it is traversed after the move.
  struct NearVisit {
    int leaf;
    Point in;
    Point out;
    bool free;
    bool begins;  // a stretch: the move to it is not counted
    int entry;    // chosen; -1: unchanged
  };

  void AddVisit(int position, bool reversed, bool free);
  void AddSegment(const Segment& segment);
  void Choose(size_t i);

  SearchState& state_;
  std::array<NearVisit, 16> visits_;
  size_t count_ = 0;
  bool begins_ = true;  // the place added next
  double old_cost_ = 0;
  double delta_ = 0;      // of the move evaluated last
  bool complete_ = true;  // its evaluation was not ended early
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_MOVE_EVALUATOR_H_
