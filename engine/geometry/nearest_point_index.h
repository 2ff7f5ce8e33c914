// Finds the nearest point of a set from which points are removed and to which they return.
//
// A tree of bounding boxes over the points in Morton order (Morton 1966). Neighbors on that curve
// are neighbors in the plane, so the tree needs no splitting planes. O(n log n) to build, O(log n)
// to remove and insert, about O(log n) for a query, however the points cluster, also in one place,
// and however few are left. Memory: about 40 bytes per point. 200 000 points: 20 ms to build.

#ifndef TRAVERSE_ENGINE_GEOMETRY_NEAREST_POINT_INDEX_H_
#define TRAVERSE_ENGINE_GEOMETRY_NEAREST_POINT_INDEX_H_

#include <cstddef>
#include <limits>
#include <vector>

#include "engine/base/budget.h"
#include "engine/geometry/bounding_box.h"
#include "engine/model/point.h"

namespace traverse {

//   NearestPointIndex index({{0, 0}, {5, 0}, {9, 0}});
//   index.Remove(1);
//   index.Nearest({6, 0});   // 2
class NearestPointIndex {
 public:
  // Point i of `points` has the id i; the set contains all of them. Asks `budget` regularly, if it
  // is not null.
  explicit NearestPointIndex(std::vector<Point> points, Budget* budget = nullptr);

  int size() const { return count_; }

  // REQUIRES: `id` is in the set, is not in the set.
  void Remove(int id) { Change(id, -1); }
  void Insert(int id) { Change(id, 1); }

  // The id of the point nearest to `p`, the smallest of several; -1 if the set is empty.
  int Nearest(Point p) const;

  // Square of the distance in mm from `p` to a point, whether or not the set contains it.
  double SquaredDistance(int id, Point p) const {
    const Point point = points_[static_cast<size_t>(place_[static_cast<size_t>(id)])];
    return (point.x - p.x) * (point.x - p.x) + (point.y - p.y) * (point.y - p.y);
  }

  // Some id of the set, the same one after the same calls; -1 if the set is empty. O(log n).
  int Any() const;

  // Promises that only Any will be called. It then takes O(1) on average, as Remove and Insert do,
  // and its ids follow a curve through the plane.
  void StopSearching() { searching_ = false; }

 private:
  // Points in a leaf of the tree.
  static constexpr size_t kLeafSize = 8;
  static constexpr int kNone = std::numeric_limits<int>::max();

  void Change(int id, int by);
  int LeastIdOfLeaf(size_t leaf) const;
  void ScanLeaf(size_t leaf, Point p, double& least, int& nearest) const;

  bool searching_ = true;
  mutable size_t first_ = 0;        // if not searching_: no earlier position is in the set
  int count_ = 0;                   // of the points in the set
  size_t leaves_ = 1;               // a power of two
  std::vector<Point> points_;       // in Morton order; leaf l has [l * kLeafSize, ...)
  std::vector<int> ids_;            // of points_
  std::vector<char> in_set_;        // of points_, and a last one that ends searches
  std::vector<int> place_;          // [id] its position in points_
  std::vector<BoundingBox> boxes_;  // [node] a heap: the children of node n are 2n and 2n + 1, the
  std::vector<int> least_id_;       // leaves begin at leaves_; of the set, kNone if it has none
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_NEAREST_POINT_INDEX_H_
