// How high a print stands, cell by cell, and where the head of the original has been beside it.
//
// The head needs room around its tip: the more, the higher something stands above the tip. A
// position is clear if everything that stands higher is that far away, or if the original's head
// was as near to it, as low or lower, since the height of what is printed last went down. For until
// then what stands higher does not grow.
//
// Memory: 6 KB for each tile of 32 x 32 cells that something is printed or moved in, and only so
// many tiles; what lies in others, or 8 m away, is not known. Time: the cells of all segments; and
// those around a position, once for each height that the head comes down to.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_HEIGHT_GRID_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_HEIGHT_GRID_H_

#include <array>
#include <climits>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

// The room that the head needs around something that stands `excess` above its tip: none up to
// `least_excess_mm`, then base_mm + excess, at most `most_mm`.
struct HeadShape {
  double least_excess_mm = 0;
  double base_mm = 0;
  double most_mm = 0;

  // The original's head was as near if it was no more than this farther away.
  double slack_mm = 0;

  // This is the tip, and where it would be inside of something, the original's was.
  bool is_tip = false;
};

class HeightGrid {
 public:
  // REQUIRES: 0.1 <= cell_mm.
  HeightGrid(double cell_mm, const HeadShape& shape) : cell_mm_(cell_mm), shape_(shape) {}

  // A straight piece of a path, printed at `z_mm`.
  void Print(Point a, Point b, double z_mm);

  // The same of a move of the original, from one height to another.
  void Visit(Point a, double z_a_mm, Point b, double z_b_mm);

  // The height of what is printed goes down.
  void ForgetVisits() { ++pass_; }

  // What a move is not clear of; the nearest that stands.
  struct Hit {
    Point at;             // what stands there
    double above_mm = 0;  // how far above the tip
    double off_mm = 0;    // how far away from it; 0: the tip is in it
  };
  std::optional<Hit> NearestHit(Point a, double z_a_mm, Point b, double z_b_mm);

  // Of all that is printed.
  double highest_mm() const;

 private:
  static constexpr int kSide = 32;
  static constexpr size_t kCells = kSide * kSide;

  // Heights in units of 0.01 mm.
  using Height = uint16_t;
  static constexpr Height kNever = UINT16_MAX;

  struct Tile {
    std::array<Height, kCells> top{};
    std::array<Height, kCells> visited{};  // as low; in pass `pass`
    std::array<Height, kCells> clear{};    // from there on upwards; the same
    Height highest = 0;
    uint32_t pass = 0;
    bool any_visit = false;
  };
  struct Cell {
    int x = 0;
    int y = 0;
  };

  static Height Units(double mm);
  template <typename Take>
  void ForEachCell(Point a, Point b, Take take) const;
  Tile* Find(int tile_x, int tile_y);
  Tile* Make(Cell cell);
  void Renew(Tile& tile) const;
  double ReachOf(int excess) const;
  std::optional<Hit> HitAt(Cell cell, Height z);
  bool WasAsNear(Cell cell, double off_mm, Height z);

  // Calls take(tile, cell, index) for the cells at most `radius_mm` from `center` of tiles that
  // wanted(tile) says; stops when take returns false.
  template <typename Wanted, typename Take>
  void ForEachAround(Cell center, double radius_mm, Wanted wanted, Take take);

  const double cell_mm_;
  const HeadShape shape_;
  absl::flat_hash_map<std::pair<int, int>, std::unique_ptr<Tile>> tiles_;  // by their place
  std::pair<int, int> last_key_{INT_MAX, INT_MAX};                         // of last_
  Tile* last_ = nullptr;
  Height highest_ = 0;
  uint32_t pass_ = 1;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_HEIGHT_GRID_H_
