// An island rests, until it is printed on, as long as in the original, or for the least layer time
// that the file states if that is shorter; and so does what counts as one island (island_tree.h).

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_RULES_REST_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_RULES_REST_H_

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/island_map.h"
#include "client/gcode/island_tree.h"
#include "client/gcode/verify/findings.h"
#include "client/gcode/verify/match/layer_pair.h"

namespace traverse::gcode {

// When a file begins to print something and when it leaves it, in seconds.
struct PrintedTime {
  double begun = std::numeric_limits<double>::infinity();
  double left = 0;
  uint32_t line = 0;  // where it begins

  void Include(const PrintedTime& part) {
    if (part.begun < begun) line = part.line;
    begun = std::min(begun, part.begun);
    left = std::max(left, part.left);
  }
};

// A node of the islands of one layer, and when both files print it.
struct PrintedIsland {
  PrintedTime was;
  PrintedTime is;
  uint32_t first_path = UINT32_MAX;  // of the layer, in the order of the original
  uint32_t last_path = 0;
};

struct PrintedIslands {
  std::vector<PrintedIsland> islands;  // [node]
  IslandTree tree;
  uint32_t paths = 0;
  std::vector<IslandCell> cells;  // ascending
};

// Paths within 0.52 mm, or about 1.25 line widths as their filament implies them, touch and are of
// one island. `height_mm` is that of the layer, `filament_mm` the filament's diameter.
PrintedIslands FindPrintedIslands(const LayerPair& layer, double height_mm, double filament_mm);

// Follows a print layer by layer.
class RestWatch {
 public:
  explicit RestWatch(double least_seconds) : least_seconds_(least_seconds) {}

  // The next layer, with index `index`.
  void Take(PrintedIslands layer, int64_t index, std::vector<Finding>& breaks);

 private:
  // A layer of which something is on top.
  struct Below {
    std::vector<PrintedIsland> islands;
    IslandTree tree;
    uint64_t first_path = 0;  // counted from the beginning of the file
    int64_t index = -1;
  };

  // The island that was printed last in a cell.
  struct Top {
    std::shared_ptr<const Below> layer;
    uint32_t island = 0;
  };

  bool RestsTooShort(const PrintedIsland& below, uint64_t first_path,
                     const PrintedIsland& island) const;

  const double least_seconds_;
  uint64_t paths_ = 0;  // of the layers taken
  absl::flat_hash_map<uint64_t, Top> top_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_RULES_REST_H_
