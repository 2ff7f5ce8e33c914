// Which paths of a layer touch, and which of those have to keep their order.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_PRECEDENCE_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_PRECEDENCE_H_

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "client/gcode/model/outline.h"

namespace traverse::gcode {

struct Contacts {
  // Pairs (i, j), i < j, of paths that touch and for which `keeps_order` was true; ascending.
  std::vector<std::pair<uint32_t, uint32_t>> ordered;

  // Whether all were looked at. Else there are none above, and all paths are of one region: more
  // than kMostPairsEach others lie near to each, which no part has and which would take as long as
  // the square of their number.
  bool complete = true;

  // [path] the connected region that it lies in: regions of paths that touch, numbered from 0 in
  // the order of their first paths.
  std::vector<uint32_t> island;
};

// Two paths touch if the middles of their lines come closer than kTouch mean widths: neighbors lie
// about 0.9 of a width apart, and what is one line further 1.8.
inline constexpr double kTouch = 1.3;

// Thin lines touch if they come as close as this.
inline constexpr double kTouchMm = 0.52;

// Pairs of paths that are looked at, for each cell of the grid that each path is in, and beyond
// what a layer may have in any case.
inline constexpr double kMostPairsEach = 100;
inline constexpr double kMostPairsOfAll = 1e6;

// `keeps_order(i, j)` is asked for i < j, once at most.
Contacts FindContacts(const std::vector<Outline>& outlines,
                      const std::function<bool(uint32_t, uint32_t)>& keeps_order);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_PRECEDENCE_H_
