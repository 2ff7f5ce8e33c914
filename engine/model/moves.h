// How the moves of a route are made, if their cost is a time.

#ifndef TRAVERSE_ENGINE_MODEL_MOVES_H_
#define TRAVERSE_ENGINE_MODEL_MOVES_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/model/point.h"

namespace traverse {

struct MoveCounts {
  int64_t crossings = 0;    // moves that cross one or more walls
  int64_t retractions = 0;  // moves that retract

  MoveCounts& operator+=(const MoveCounts& other) {
    crossings += other.crossings;
    retractions += other.retractions;
    return *this;
  }

  friend bool operator==(const MoveCounts&, const MoveCounts&) = default;
};

// The move to visit number `visit` of a route leads around walls, over these points.
struct Detour {
  size_t visit = 0;
  std::vector<Point> points;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_MOVES_H_
