// In which cells of the plate islands lie: what stands on what, told by cells of 1 mm. Writer and
// verifier find islands each by its own means; where one lies is arithmetic.

#ifndef TRAVERSE_CLIENT_GCODE_ISLAND_CELLS_H_
#define TRAVERSE_CLIENT_GCODE_ISLAND_CELLS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace traverse::gcode {

// No plate is larger, in mm on either side of the origin. Beyond it there is one cell.
inline constexpr double kFarCells = 4000;

// No layer has more cells with something in them, and no print more that are remembered; of what
// lies in further ones nothing is known.
inline constexpr size_t kMostCellsOfLayer = 1 << 18;
inline constexpr size_t kMostCellsOfPrint = 1 << 19;

// A cell, and an island that lies in it.
using IslandCell = std::pair<uint64_t, uint32_t>;

// The cell at a point, in mm.
inline uint64_t CellAt(double x, double y) {
  const auto index = [](double value) {
    const double cell = std::clamp(std::floor(value), -kFarCells, kFarCells);
    return static_cast<uint32_t>(static_cast<int32_t>(cell));
  };
  return uint64_t{index(x)} << 32 | index(y);
}

// The cells of a layer, each once.
class IslandCells {
 public:
  bool full() const { return full_; }

  // Leaves `cell` out if the set is full.
  void Add(const IslandCell& cell) {
    if (full_ || (!cells_.empty() && cells_.back() == cell)) return;
    cells_.push_back(cell);
    if (cells_.size() < room_) return;
    Tidy();
    full_ = cells_.size() >= kMostCellsOfLayer;
    room_ = 2 * cells_.size() + kLeastRoom;
  }

  // Ascending.
  std::vector<IslandCell> Take() {
    Tidy();
    return std::move(cells_);
  }

 private:
  static constexpr size_t kLeastRoom = 1 << 16;

  void Tidy() {
    std::sort(cells_.begin(), cells_.end());
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
  }

  std::vector<IslandCell> cells_;
  size_t room_ = kLeastRoom;
  bool full_ = false;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_ISLAND_CELLS_H_
