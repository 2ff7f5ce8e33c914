// Which order each layer is done in, where a layer's end is where the way to the next one begins.
//
// The choices are the columns of a graph whose edges are the ways between layers, measured; the
// best row of them is a shortest path. What holds for each layer by itself forbids edges. What
// holds for the whole file is priced: so high that the best row at that price keeps to it.
// O(layers * choices^2) for each price that is tried.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_CHOICE_ROW_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_CHOICE_ROW_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/gcode/measure/print_totals.h"
#include "client/gcode/plan/policy.h"

namespace traverse::gcode {

// The choices for one layer. Choice 0 is the order of the file, and always there.
struct ChoiceColumn {
  std::vector<PrintTotals> inside;  // [choice] its paths and the ways between them
  std::vector<PrintTotals> ways;    // [before * choices + choice] from the layer before

  // What is not to be chosen.
  std::vector<bool> no_choice;  // [choice]
  std::vector<bool> no_way;     // [as ways]

  // With the way to it; `before` is of no meaning for the first layer, which has no ways.
  PrintTotals Whole(size_t before, size_t choice) const;
};

// The row of choices with the least estimated time; under Crossings::kFewer a crossing counts as
// time. Each layer, with the way to it, has no more and no longer open ways across visible walls
// than in the file, and as much filament pushed beyond what was pulled back; under Policy::kSafe no
// more travel. The whole file has at least `fewer` ways across visible walls fewer than it had, but
// under Crossings::kAny; all as in the file if no row that was found has. It has no more retractions
// than it had, unless each one more saves a second. REQUIRES: not empty.
std::vector<uint32_t> BestRow(const std::vector<const ChoiceColumn*>& columns, Policy policy,
                              Crossings crossings, int64_t fewer = 0);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_CHOICE_ROW_H_
