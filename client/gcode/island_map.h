// Where the islands of a layer lie: in which cells of the plate, which tells what stands on what,
// and how far apart. Writer and verifier find islands each by its own means; where one lies is
// arithmetic.

#ifndef TRAVERSE_CLIENT_GCODE_ISLAND_MAP_H_
#define TRAVERSE_CLIENT_GCODE_ISLAND_MAP_H_

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "client/gcode/island_tree.h"

namespace traverse::gcode {

// No plate is larger, in mm on either side of the origin; of what lies beyond nothing is known.
inline constexpr double kFarthestMm = 4000;

// No layer has more cells with something in them, and no print more that are remembered; of what
// lies in further ones nothing is known. Nor has a layer many more points in its cells, unless it
// is printed in the same places again and again.
inline constexpr size_t kMostCellsOfLayer = 1 << 18;
inline constexpr double kMostPointsOfLayer = 16 * kMostCellsOfLayer;
inline constexpr size_t kMostCellsOfPrint = 1 << 19;

// A cell of 1 mm, and an island that lies in it.
using IslandCell = std::pair<uint64_t, uint32_t>;

class IslandMap {
 public:
  // Of `count` islands, numbered from 0.
  explicit IslandMap(uint32_t count) : count_(count) {}

  // What comes next is left out.
  bool full() const { return full_; }

  // Adds a straight line of island `island`, as far as it lies on the plate. Points half a mm apart
  // are looked at: no cell is missed but for corners. In mm.
  void AddLine(double from_x, double from_y, double to_x, double to_y, uint32_t island);

  // Each once, ascending.
  std::vector<IslandCell> TakeCells();

  // The islands, and what they count as together. Where very many points are near each other each
  // counts for itself. O(n log n) in the points.
  IslandTree TakeTree();

 private:
  struct PrintedPoint {
    double x = 0;
    double y = 0;
    uint32_t island = 0;
    uint64_t cell = 0;  // none of which is narrower than the greatest gap
  };

  void Add(const PrintedPoint& point);
  void Tidy();
  static std::vector<IslandGap> GapsOf(const std::vector<PrintedPoint>& points);

  static constexpr size_t kLeastRoom = 1 << 16;

  const uint32_t count_;
  std::vector<IslandCell> cells_;
  std::vector<PrintedPoint> points_;  // unless there is one island
  size_t room_ = kLeastRoom;
  double looked_at_ = 0;
  bool full_ = false;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_ISLAND_MAP_H_
