// A layer as its paths and the tree of orders in which they may be done: what islands and plans
// have in common.

#ifndef TRAVERSE_CLIENT_WARM_START_LAYER_SHAPE_H_
#define TRAVERSE_CLIENT_WARM_START_LAYER_SHAPE_H_

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "absl/types/span.h"
#include "client/input/input_job.h"
#include "traverse/v1/plan.pb.h"

namespace traverse {

// A path, by what names it in the file and in the API.
struct ShapePath {
  bool contour = false;
  bool one_way = false;
  uint64_t island = 0;  // labels, as --json states them
  uint64_t id = 0;
  absl::Span<const double> points;  // of the layer: x0, y0, x1, y1, ...
  std::vector<uint32_t> entries;    // vertices where it may be entered; of an open path 0 and 1
  v1::Visit name;                   // without the entry
  int parent = -1;                  // the node whose child its leaf is; -1: it is all

  // Where it begins and where it ends if it is entered there.
  std::pair<double, double> Enter(uint32_t entry) const;
  std::pair<double, double> Exit(uint32_t entry) const;

  v1::Visit VisitAt(uint32_t entry) const;
};

struct ShapeNode {
  int path = -1;  // of a leaf
  bool in_order = false;
  std::vector<int> children = {};  // greater than this node's own number
  std::vector<std::pair<int, int>> before = {};
};

struct LayerShape {
  std::vector<ShapePath> paths;
  std::vector<ShapeNode> nodes;
};

// Unset if the layer is not one that the service takes: that says why. `notes` may be null. Refers
// to `layer`. O(points + pairs).
std::optional<LayerShape> ShapeOf(const v1::Layer& layer, bool interleaved, const PathNotes* notes);

// An order of the paths that the tree allows: children by the least rank of their paths, as far as
// the pairs let them. A legal order is returned as it is if it is that of the ranks. `ranks` are
// finite. O(n log n).
std::vector<int> OrderByRanks(const LayerShape& shape, absl::Span<const double> ranks);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_WARM_START_LAYER_SHAPE_H_
