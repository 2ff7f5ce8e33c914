// Chooses one order for each layer, where the end of a layer is the start of the travel to the
// next.
//
// The choices of a layer are a column of a graph; the edges are the measured travel moves between
// layers, so the best row of choices is a shortest path. Rules for a layer forbid edges; rules for
// the file become a price, so high that the best row obeys them. O(layers * choices^2) per price.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_CHOICE_ROW_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_CHOICE_ROW_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/gcode/measure/print_totals.h"
#include "client/gcode/plan/policy.h"

namespace traverse::gcode {

// The choices for one layer. Choice 0 is the file's own order, and always exists.
struct ChoiceColumn {
  std::vector<PrintTotals> inside;   // [choice] its paths and the travel between them
  std::vector<PrintTotals> travels;  // [before * choices + choice] travel from the layer before

  // What must not be chosen.
  std::vector<bool> no_choice;  // [choice]
  std::vector<bool> no_travel;  // [as travels]

  // Of `travels`. REQUIRES: this is not the first layer.
  const PrintTotals& Travel(size_t before, size_t choice) const;

  // Including the travel to the layer. `before` is ignored for the first layer, which has none.
  PrintTotals Whole(size_t before, size_t choice) const;
};

// The row of choices with the least estimated time; under Crossings::kFewer a crossing counts as
// time, or as less of it if the row would take longer than the file. No layer, with the move to it,
// has more moves where something is in the way, more or longer unretracted moves across visible
// walls than in the file, or more filament pushed beyond what was retracted. Except under
// Crossings::kAny, the whole file has at least `fewer` fewer crossings of visible walls than
// before; if no row does, the file's own orders are returned. The file has no more retractions than
// before, unless each additional one saves 0.3 s. REQUIRES: not empty.
std::vector<uint32_t> BestRow(const std::vector<const ChoiceColumn*>& columns, Crossings crossings,
                              int64_t fewer = 0);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_CHOICE_ROW_H_
