// Finds the paths of an earlier route in a layer that may have been edited since.

#ifndef TRAVERSE_CLIENT_WARM_START_MATCH_PATHS_H_
#define TRAVERSE_CLIENT_WARM_START_MATCH_PATHS_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "client/warm_start/earlier_routes.h"
#include "client/warm_start/layer_shape.h"

namespace traverse {

// What an earlier visit has become.
struct FoundPath {
  int path = -1;  // of the shape; -1: gone
  uint32_t entry = 0;
};

// For each visit of `route` the path that is probably the same, each path at most once. First what
// has stayed in its place; then what was moved together with most of what else has its labels; then
// what is of the same kind and within kMovedMm; last what has the same labels. O(n log n) for paths
// whose points are spread.
std::vector<FoundPath> MatchPaths(absl::Span<const EarlierVisit> route, const LayerShape& shape);

inline constexpr double kMovedMm = 2;

// How many visits have stayed in their places, of those whose places are known.
struct Stayed {
  size_t visits = 0;
  size_t known = 0;
};
Stayed CountStayed(absl::Span<const EarlierVisit> route, const LayerShape& shape);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_WARM_START_MATCH_PATHS_H_
