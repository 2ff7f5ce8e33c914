// One turned order for each layer of a print, so that islands rest between them.
//
// Where an order of a layer begins is of little cost; which of them may follow each other is not
// up to one layer. So the turns of all layers (island_turns.h) are looked at together, by
// estimates: a shortest path through them, whose edges are the pairs that leave each island enough
// rest.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_RESTED_ROW_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_RESTED_ROW_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "client/gcode/choose/orders/island_turns.h"
#include "client/gcode/choose/rows/island_rests.h"
#include "engine/model/point.h"

namespace traverse::gcode {

// The turns of one layer that may be chosen, besides the file's own order.
struct TurnedLayer {
  uint32_t first_block = 0;
  IslandTurns turns;
  std::vector<Point> begin;  // [turn] where its first path begins
  std::vector<Point> end;    // [turn] and where its last one ends

  // The file's own order, and the travel to it as measured.
  TravelTotals given;
  IslandTimes given_times;
  Point given_begin;
  Point given_end;
  double given_travel_mm = 0;
};

// [layer] the turn to take, unset for the file's own order: the row that takes the least time if a
// crossing of a visible wall counts as `crossing_seconds`. O(turns^2) a layer and its supports.
std::vector<std::optional<uint32_t>> RestedRow(const IslandRests& rests,
                                               const std::vector<TurnedLayer>& layers,
                                               double crossing_seconds);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_RESTED_ROW_H_
