// Points of a layer's paths: the nearest one, and those within a radius, while paths are taken out.

#ifndef TRAVERSE_CLIENT_WARM_START_POINT_TREE_H_
#define TRAVERSE_CLIENT_WARM_START_POINT_TREE_H_

#include <cstddef>
#include <utility>
#include <vector>

namespace traverse {

// A point of something that the caller numbers.
struct OwnedPoint {
  double x = 0;
  double y = 0;
  int owner = 0;   // from 0
  int vertex = 0;  // of its owner's
};

// A k-d tree. O(n log n) to build; a query takes about O(log n), for points that are spread.
class PointTree {
 public:
  // REQUIRES: coordinates are finite.
  explicit PointTree(std::vector<OwnedPoint> points);

  // The point nearest to (x, y) whose owner was not removed; of several the one of the least owner
  // and vertex. Null if there is none.
  const OwnedPoint* Nearest(double x, double y) const;

  // Those within `radius` of (x, y) whose owners were not removed.
  std::vector<OwnedPoint> Within(double x, double y, double radius) const;

  void Remove(int owner);

 private:
  struct Range {
    size_t begin = 0;
    size_t end = 0;
    bool by_x = true;
    size_t middle() const { return begin + (end - begin) / 2; }
    Range below() const { return {begin, middle(), !by_x}; }
    Range above() const { return {middle() + 1, end, !by_x}; }
  };
  struct Best {
    const OwnedPoint* point = nullptr;
    double square = 0;
  };

  void Build(Range range);
  void Look(Range range, double x, double y, Best& best) const;
  void Collect(Range range, double x, double y, double square,
               std::vector<OwnedPoint>& found) const;

  std::vector<OwnedPoint> points_;              // the root of a range is its middle
  std::vector<int> left_;                       // [middle] points of its range that are not removed
  std::vector<bool> removed_;                   // [position]
  std::vector<std::vector<size_t>> positions_;  // [owner]
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_WARM_START_POINT_TREE_H_
