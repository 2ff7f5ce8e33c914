// The entries of all leaves of an OrderTree, laid out for the inner loops of local search.

#ifndef TRAVERSE_ENGINE_SEARCH_ENTRIES_LEAF_ENTRIES_H_
#define TRAVERSE_ENGINE_SEARCH_ENTRIES_LEAF_ENTRIES_H_

#include <cassert>
#include <cstddef>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/rest.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/search/entries/entry_kernels.h"

namespace traverse {

// Leaves are the paths of the plan and behind them two more, the start and the finish, which have
// one entry each (the finish a meaningless one if the problem has none). The entries of leaf l are
// [first(l), first(l) + count(l)), in the order of EntryTable: of an open path, forward and then
// backward. Behind the entries of a contour with several the last one is repeated up to a
// multiple of kLanes, for vector instructions. Memory: 44 bytes an entry.
class LeafEntries {
 public:
  static constexpr int kLanes = 8;

  // `budget`, if there is one, is asked meanwhile; the entries are whole all the same.
  explicit LeafEntries(const LayerProblem& problem, Budget* budget = nullptr);

  int leaf_count() const { return static_cast<int>(count_.size()); }
  int first(int leaf) const { return first_[Index(leaf)]; }
  int count(int leaf) const { return count_[Index(leaf)]; }
  bool open(int leaf) const { return open_[Index(leaf)]; }

  Point enter(int entry) const { return enter_[Index(entry)]; }
  Point exit(int entry) const { return exit_[Index(entry)]; }

  // The entry that runs an open path the other way. REQUIRES: open(leaf), count(leaf) == 2.
  int Reversed(int leaf, int entry) const {
    assert(open(leaf) && count(leaf) == 2);
    return 2 * first(leaf) + 1 - entry;
  }

  // Half the longer side of the box around a contour's entries, in mm: how far another entry may
  // be. 0 for open paths.
  double radius(int leaf) const { return radius_[Index(leaf)]; }
  absl::Span<const double> radii() const { return radius_; }

  Visit VisitOf(int leaf, int entry) const { return Visit{leaf, visit_entry_[Index(entry)]}; }
  int EntryOf(const Visit& visit) const;

  // The entry of `leaf` that costs least between a visit that ends at `from` and one that begins at
  // `to`; null: nothing comes after it. Of entries that cost the same up to 1e-5, any. With walls,
  // the best of the entries that might cost less than the one that is best without them.
  int Best(int leaf, Point from, const Point* to, const TravelCost& cost) const;

  // The same in two steps, for many `from` and one `to`, of a contour: tails[i] is set to the cost
  // from entry i on.
  void FillTails(int leaf, const Point* to, std::vector<float>& tails) const;
  int BestWithTails(int leaf, Point from, const std::vector<float>& tails) const;

  // For choosing the entries of two contours, a and then b, between `from` and `to`: sets bounds[i]
  // to what entry i of a costs at least with any entry of b, up to 1e-5. `tails`: of b, to `to`.
  void FillPairBounds(int a, int b, Point from, const Point* to, const std::vector<float>& tails,
                      std::vector<float>& bounds) const;

  // Entries of a contour with those that fill up the last vector; there are none behind a single
  // one, which needs no choice.
  int PaddedCount(int leaf) const {
    return count(leaf) == 1 ? 1 : (count(leaf) + kLanes - 1) / kLanes * kLanes;
  }

 private:
  static size_t Index(int i) { return static_cast<size_t>(i); }

  void Reserve(const Plan& plan, Budget* budget);
  void AddPath(const Path& path, Rest& rest);
  int BestByLength(int leaf, Point from, const Point* to) const;
  int BestAmongWalls(int leaf, Point from, const Point* to, const TravelCost& cost) const;
  void AddEntry(Point enter, Point exit, int visit_entry);
  void CloseLeaf(int count, bool open);
  FloatEntries Floats(int leaf) const {
    return {x_.data() + first(leaf), y_.data() + first(leaf), PaddedCount(leaf)};
  }
  FloatPoint Relative(Point p) const {
    return {static_cast<float>(p.x - origin_.x), static_cast<float>(p.y - origin_.y)};
  }
  FloatBox BoxOf(int leaf) const { return boxes_[Index(leaf)]; }
  const FloatTime* time() const { return time_ ? &*time_ : nullptr; }

  std::vector<int> first_;        // [leaf]
  std::vector<int> count_;        // [leaf]
  std::vector<char> open_;        // [leaf]
  std::vector<double> radius_;    // [leaf]
  std::vector<FloatBox> boxes_;   // [leaf] around the entries of a contour, relative to origin_
  std::vector<Point> enter_;      // [entry]
  std::vector<Point> exit_;       // [entry]
  std::vector<int> visit_entry_;  // [entry] Visit::entry

  std::optional<FloatTime> time_;  // unset: the cost is a length

  // [entry] enter_ less origin_, in single precision: enough to tell which entry is best.
  Point origin_;
  std::vector<float> x_;
  std::vector<float> y_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_ENTRIES_LEAF_ENTRIES_H_
