// The search for 3-opt moves among near neighbors.
//
//   ... t1 | t2 ... t4 | t3 ... t5 | t6 ...     cut after t1; t2 wants t3 for a neighbor, so cut
//                                               next to t3; t4 wants t5; t6 is left for t1
//
// The search looks for one cut after another, only on either side of near neighbors, and only while
// the removed moves cost more than the added ones: begun at the right visit, this finds every
// improving exchange (Lin and Kernighan 1973). It judges changes of cost with the present entries,
// but with some slack, because entries will be chosen again (move_evaluator.h).

#ifndef TRAVERSE_ENGINE_SEARCH_THREE_OPT_H_
#define TRAVERSE_ENGINE_SEARCH_THREE_OPT_H_

#include <algorithm>
#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "engine/cost/neighbor_lists.h"
#include "engine/search/end_groups.h"
#include "engine/search/search_state.h"
#include "engine/search/segment_move.h"

namespace traverse {

struct ThreeOptOptions {
  int first_breadth = 8;   // neighbors considered for t3
  int second_breadth = 5;  // and for t5
  size_t keep = 4;         // most moves found by one search

  // Most visits between the cuts of a move applied on trial; applying and undoing it takes as long.
  int longest_trial = 1000;

  // By how much a move may seem to lose: as shares of the radii of the contours at the cuts.
  double slack = 0.6;         // as a whole
  double first_slack = 0.5;   // after t3
  double second_slack = 0.2;  // after t5
};

class ThreeOpt {
 public:
  struct Found {
    SegmentMove move;
    double delta = 0;  // with the present entries
  };

  // The move after which a search may continue from the same t1, as in Lin-Kernighan: among those
  // that the plan allows the one with the largest gain, without counting the last added edge.
  struct Open {
    SegmentMove move;
    double delta = 0;
    double gain = 0;
    int t2 = -1;  // next to t1 after the move; -1: there is none
  };

  // The arguments must outlive the search.
  ThreeOpt(const SearchState& state, const NeighborLists& neighbors, const ThreeOptOptions& options)
      : state_(state),
        at_(state.arrays()),
        radius_(state.entries().radii().data()),
        neighbors_(neighbors),
        options_(options) {}

  // Looks for moves that the plan allows and that cut the edge after the leaf t1 (`forward`) or
  // before it. `debt`: how much the route costs above the one to be improved. Without
  // `wants_open`, nobody needs open() and it stays empty: most moves then prove too bad without
  // their last edge.
  void Search(int t1, bool forward, double debt, bool wants_open = true);

  // The moves that the last search found: deltas up to `debt`, least first.
  absl::Span<const Found> found() const { return found_; }
  const Open& open() const { return open_; }

 private:
  // One side of a cut between two positions.
  struct End {
    int leaf;
    bool right;  // of the cut: the leaf comes after it
    Point point;
  };
  struct Cut {
    int position;  // of the leaf left of it
    double cost;   // of the edge that is cut
  };

  End EndAt(int leaf, bool right) const;
  End OtherEnd(const Cut& cut, const End& end) const;
  Cut CutAt(const End& end) const;
  bool RightOf(int group, int leaf) const;
  bool IsEnd(int group, const End& end) const;
  absl::Span<const NeighborLists::Neighbor> NeighborsOf(const End& end, int breadth) const;
  double LimitMm(double limit) const;
  double Radius(int leaf) const { return radius_[leaf]; }

  // Deltas from here on are rejected, if contours with these radii are at the cuts.
  double LeastRejected(double radii) const {
    const double slack = options_.slack * radii;
    return found_.size() < options_.keep ? slack : std::min(slack, found_.back().delta);
  }

  // Cost: callable with two points, so that the inner loops compute a length without a branch.
  template <typename Cost>
  double Join(const End& a, const End& b, const Cost& cost) const;
  template <typename Cost>
  void SearchFirst(int t1, bool forward, double debt, const Cost& cost);
  template <typename Cost>
  double CostTo(const End& from, const End& to, const NeighborLists::Neighbor& neighbor,
                const Cost& cost) const;
  template <typename Cost>
  void SearchSecond(const End& t3, double joined, const Cost& cost);
  template <typename Cost>
  void SearchThird(const End& t5, int kind, double joined, const Cost& cost);
  template <typename Cost>
  double LeastOf(const End& a, const End& b, const Cost& cost) const;
  template <typename Cost>
  bool MayKeep(const End& from, const End& to, double gain, double radii, const Cost& cost) const;
  void SetKinds(int left, int right);
  int KindAt(int position, bool right) const;
  void Offer(const SegmentMove& move, double delta, double gain, int last_leaf, double radii);

  const SearchState& state_;
  const SearchState::Arrays at_;
  const double* const radius_;  // [leaf]
  const NeighborLists& neighbors_;
  const ThreeOptOptions options_;

  // The current search.
  bool wants_open_ = true;
  End t1_{}, t2_{}, t3_{}, t4_{};
  Cut cut1_{}, cut2_{};
  double gain0_ = 0;  // cost of the cut edges less that of the added ones so far
  double gain1_ = 0;
  double radii_ = 0;  // of the contours at the first two cuts
  int left_ = 0;      // the first two cuts, in the order of the route
  int right_ = 0;
  int kinds_[2][3] = {};  // the move by the third cut's position and the side of t5; see SetKinds

  std::vector<Found> found_;
  Open open_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_THREE_OPT_H_
