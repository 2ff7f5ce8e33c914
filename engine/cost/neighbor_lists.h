// The nearest neighbors of groups of points.
//
// A group is what a route may enter or leave at one place of its choice: all vertices of a contour,
// or one end of an open path. Local search looks for new moves between near groups only, so that
// its work grows with the number of groups and not with its square (Johnson and McGeoch 1997).
//
// A tree over the points, halved at the median of the longer side (Bentley 1975), answers one
// query a group. O(n log n) for n points, whatever their distribution. Of a large group a sample of
// kSamples points takes part; the distances are refined over all of its points afterwards. 1000
// contours of 40 vertices and as many rasters: 7 ms (tests/bench/micro).

#ifndef TRAVERSE_ENGINE_COST_NEIGHBOR_LISTS_H_
#define TRAVERSE_ENGINE_COST_NEIGHBOR_LISTS_H_

#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/model/point.h"

namespace traverse {

// Groups of points, numbered from 0: the points of group g are points[first[g]] to
// points[first[g + 1] - 1]. `first` has one element more than there are groups.
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

  // Groups between which neighbors are looked for: groups of the same owner are no neighbors.
  struct Member {
    int group = 0;
    int owner = 0;
  };

  // Points of a large group that stand for it when neighbors are looked for.
  static constexpr size_t kSamples = 12;

  // Nobody has neighbors yet. `groups` outlives the lists.
  explicit NeighborLists(const PointGroups& groups);

  // Finds for each member its `count` nearest members of other owners. When the budget runs out,
  // the members that are left get none. REQUIRES: not sealed; every group at most once.
  void FindAmong(absl::Span<const Member> members, int count, Budget& budget);

  // Ends the search, asking `budget` meanwhile, if there is one; if that has run out, nobody has
  // neighbors. Only then `of` may be called.
  void Seal(Budget* budget = nullptr);

  // Nearest first.
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

  // In blocks, as a long array takes long to be moved and to be freed.
  static constexpr size_t kBlock = 1 << 15;
  void Note(const Found& found);

  const PointGroups& groups_;
  std::vector<std::vector<Found>> found_;
  std::vector<int> first_;  // [group] where its neighbors begin; one more
  std::vector<Neighbor> neighbors_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_NEIGHBOR_LISTS_H_
