// Which paths of a layer touch, and which of those must keep their order.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_PRECEDENCE_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_PRECEDENCE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "client/gcode/model/outline.h"

namespace traverse::gcode {

struct Contacts {
  // Pairs (i, j), i < j, of touching paths for which `keeps_order` was true; ascending.
  std::vector<std::pair<uint32_t, uint32_t>> ordered;

  // Whether all pairs were examined. If not, there are none above and all paths form one region:
  // more than kMostPairsEach others lie near each path, or kMostOrderedEach of them keep their
  // order with it, which no real part has. To examine and to keep them would take as much as the
  // square of their number.
  bool complete = true;

  // [path] the connected region of touching paths that contains it. Regions are numbered from 0 in
  // the order of their first paths.
  std::vector<uint32_t> island;
};

// Two paths touch if the middles of their lines are closer than kTouch mean widths: neighbors lie
// about 0.9 widths apart, the next line 1.8. From one width on there is air between them.
inline constexpr double kTouch = 1.1;

// Thin lines touch if they are this close.
inline constexpr double kTouchMm = 0.52;

// Pairs of paths to examine, for each cell of the grid that each path is in, in addition to what
// any layer may have.
inline constexpr double kMostPairsEach = 100;
inline constexpr double kMostPairsOfAll = 1e6;

// Pairs that keep their order, for each path. Paths that touch and do not cross make a planar
// graph, which has at most three pairs for each: this is ten times as many.
inline constexpr size_t kMostOrderedEach = 30;

// Asks `keeps_order(i, j)` for i < j, again and again.
Contacts FindContacts(const std::vector<Outline>& outlines,
                      const std::function<bool(uint32_t, uint32_t)>& keeps_order);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_PRECEDENCE_H_
