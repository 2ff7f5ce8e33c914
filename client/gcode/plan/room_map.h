// How high the head has to be at each place, so that it touches nothing that stands.
//
// The head needs room around its tip: the more, the higher something stands above the tip. Where
// the file leads it as near to something, it may be as near at the same height or higher.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_ROOM_MAP_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_ROOM_MAP_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "engine/geometry/bounding_box.h"
#include "engine/model/point.h"

namespace traverse::gcode {

// In units of 0.01 mm.
using RoomHeight = uint16_t;

RoomHeight InRoomHeight(double mm);

// Part of the head: it needs base_mm, and as much more as something stands above the tip, but no
// more than most_mm; and no room where that is no more than `least_excess_mm`. It may be `slack_mm`
// nearer to something than the file's head was.
struct HeadPart {
  double cell_mm = 0.5;
  double least_excess_mm = 0;
  double base_mm = 0;
  double most_mm = 0;
  double slack_mm = 0;
};

// Cells, from `low` on.
struct RoomBox {
  Point low;
  double cell_mm = 1;
  int columns = 1;
  int rows = 1;
};

// The heights, where they matter. Memory: 0.5 KB for 256 cells.
class RoomMap {
 public:
  // True if a move between the two points, at these heights, is high enough everywhere.
  bool IsClear(Point a, double z_a_mm, Point b, double z_b_mm) const;

  size_t tiles() const { return tiles_.size(); }

 private:
  friend class RoomBuilder;

  static constexpr int kSide = 16;
  using Tile = std::array<RoomHeight, static_cast<size_t>(kSide* kSide)>;

  RoomHeight At(int column, int row) const;

  RoomBox box_;
  RoomHeight highest_ = 0;
  absl::flat_hash_map<uint32_t, Tile> tiles_;  // by column << 16 | row of tiles
};

// Finds the heights while a file is followed, a pass at a time: a pass is what is printed until the
// height goes down. Memory: 8 bytes a cell, and at most a million cells in the box.
class RoomBuilder {
 public:
  // Of what is printed within `bounds`.
  RoomBuilder(const BoundingBox& bounds, const HeadPart& part);

  // A straight piece of a path, or of a move of the file.
  void Print(Point a, Point b, double z_mm);
  void Visit(Point a, double z_a_mm, Point b, double z_b_mm);

  // The pass ends: how high the head has to be in it where it was, and between. What is printed in
  // it stands from now on. Empty if that takes more steps than are left of `steps`.
  RoomMap EndPass(int64_t& steps);

 private:
  // Cells [begin, end) in either direction.
  struct Window {
    int column_begin = INT32_MAX;
    int row_begin = INT32_MAX;
    int column_end = 0;
    int row_end = 0;

    void Add(int column, int row);
    bool empty() const { return column_end == 0; }
    bool Has(int column, int row) const {
      return column_begin <= column && column < column_end && row_begin <= row && row < row_end;
    }
  };
  struct Offset {
    int column = 0;
    int row = 0;
    double cells = 0;      // how far that is
    RoomHeight least = 0;  // what may stand so far away, above the tip
  };

  size_t Index(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(box_.columns) +
           static_cast<size_t>(column);
  }
  RoomHeight LowestAt(int column, int row) const;
  void Spread(int column, int row, int64_t& steps);
  void Gather(RoomMap& map) const;
  void Forget();

  HeadPart part_;
  RoomBox box_;
  int reach_ = 0;                   // cells
  std::vector<Offset> offsets_;     // nearest first
  std::vector<RoomHeight> top_;     // what stood before the pass
  std::vector<RoomHeight> now_;     // what is printed in it
  std::vector<RoomHeight> lowest_;  // of the head in it
  std::vector<RoomHeight> need_;    // scratch
  Window printed_;
  Window visited_;
  RoomHeight pass_low_ = UINT16_MAX;
  RoomHeight highest_ = 0;  // of top_
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_ROOM_MAP_H_
