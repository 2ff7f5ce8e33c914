// The nearest neighbors of groups of points.
//
// A group is a set of points of which a route may choose one to enter or leave: all vertices of a
// contour, or one end of an open path. Local search looks for new moves only between near groups,
// so its work grows with the number of groups and not its square (Johnson and McGeoch 1997).
//
// A tree over the points, halved at the median of the longer side (Bentley 1975), answers one query
// per group. O(n log n) for n points, whatever their distribution. A large group takes part with a
// sample of kSamples points; afterwards the distances are refined over all of its points. 1000
// contours of 40 vertices and as many rasters: 7 ms (tests/bench/micro).

#ifndef TRAVERSE_ENGINE_COST_NEIGHBOR_LISTS_H_
#define TRAVERSE_ENGINE_COST_NEIGHBOR_LISTS_H_

#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/model/point.h"

namespace traverse {

// Groups of points, numbered from 0: group g has points[first[g]] to points[first[g + 1] - 1].
// `first` has one element more than there are groups.
struct PointGroups {
  std::vector<Point> points;
  std::vector<int> first = {0};

  int size() const { return static_cast<int>(first.size()) - 1; }
  absl::Span<const Point> of(int group) const {
    const size_t begin = static_cast<size_t>(first[static_cast<size_t>(group)]);
    const size_t end = static_cast<size_t>(first[static_cast<size_t>(group) + 1]);
    return absl::MakeConstSpan(points).subspan(begin, end - begin);
  }

  // Ends the group to which `points` were appended.
  void Close() { first.push_back(static_cast<int>(points.size())); }
};

class NeighborLists {
 public:
  struct Neighbor {
    int group = 0;
    double distance_mm = 0;  // between the nearest points of the two groups; rarely a little more
  };

  // A group that takes part in a search. Groups of the same owner are not neighbors.
  struct Member {
    int group = 0;
    int owner = 0;
  };

  // Points that represent a large group in a search.
  static constexpr size_t kSamples = 12;

  // Starts without neighbors. `groups` must outlive the lists.
  explicit NeighborLists(const PointGroups& groups);

  // Finds for each member its `count` nearest members of other owners. When the budget runs out,
  // the remaining members get none. REQUIRES: not sealed; every group at most once.
  void FindAmong(absl::Span<const Member> members, int count, Budget& budget);

  // Ends the search; `of` may be called only after this. Asks `budget` regularly, if it is not
  // null; if that has run out, no group has neighbors.
  void Seal(Budget* budget = nullptr);

  // The neighbors of `group`, nearest first.
  absl::Span<const Neighbor> of(int group) const {
    const size_t begin = static_cast<size_t>(first_[static_cast<size_t>(group)]);
    const size_t end = static_cast<size_t>(first_[static_cast<size_t>(group) + 1]);
    return absl::MakeConstSpan(neighbors_.data() + begin, end - begin);
  }

 private:
  struct Found {
    int from = 0;
    Neighbor neighbor;
  };

  // Neighbors are kept in blocks, because moving and freeing one long array takes long.
  static constexpr size_t kBlock = 1 << 15;
  void Note(const Found& found);

  const PointGroups& groups_;
  std::vector<std::vector<Found>> found_;
  std::vector<int> first_;  // [group] where its neighbors begin; one more at the end
  std::vector<Neighbor> neighbors_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_NEIGHBOR_LISTS_H_
