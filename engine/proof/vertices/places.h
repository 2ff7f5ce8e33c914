// The points of a plan's ends, neighboring ones taken together as one place.
//
// A route that is bounded may enter and leave a place at different points of it, so between places
// the distance of their nearest points counts. Where a solution passes through a place of several
// points, splitting it makes the bound better (vertex_bound.h); elsewhere a few large places do.

#ifndef TRAVERSE_ENGINE_PROOF_VERTICES_PLACES_H_
#define TRAVERSE_ENGINE_PROOF_VERTICES_PLACES_H_

#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "engine/geometry/bounding_box.h"
#include "engine/model/point.h"
#include "engine/proof/trees/end_graph.h"

namespace traverse {

// Numbered through all ends. Each is a run of the points of its end.
class Places {
 public:
  // At most so many places of an end, as small as can be. `graph` outlives this. REQUIRES:
  // most_of_end >= 1.
  Places(const EndGraph& graph, size_t most_of_end);

  int count() const { return static_cast<int>(places_.size()); }
  int end_of(int place) const { return at(place).end; }

  // The places of `end` are [first(end), first(end + 1)).
  int first(int end) const { return first_[static_cast<size_t>(end)]; }
  int size(int end) const { return first(end + 1) - first(end); }

  // In order along the path.
  absl::Span<const Point> points(int place) const;
  const BoundingBox& box(int place) const { return at(place).box; }

  // The diagonal of the box: 0 if there is nothing to split.
  double width(int place) const;

  // The least distance between points of two places, or less: that of the boxes of two places of
  // many points.
  double LeastDistance(int a, int b) const;

  // Distances between points that were computed so far: a measure of work.
  double distances() const { return distances_; }

  // Splits each place p with marked[p] != 0 and a width into two. What p was is then [first[p],
  // first[p + 1]), which is returned. REQUIRES: marked has as many elements as there are places.
  std::vector<int> Split(const std::vector<char>& marked);

 private:
  struct Place {
    int end = 0;
    int begin = 0;  // points of the end
    int behind = 0;
    BoundingBox box;
  };

  const Place& at(int place) const { return places_[static_cast<size_t>(place)]; }
  Place MakePlace(int end, int begin, int behind) const;
  void SplitInto(const Place& place, std::vector<Place>& parts) const;
  void FindFirst();

  const EndGraph* graph_;
  std::vector<Place> places_;
  std::vector<int> first_;  // [end]; one more
  mutable double distances_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_VERTICES_PLACES_H_
