// Chooses the entries of a given route again.

#ifndef TRAVERSE_ENGINE_COST_ROUTE_ENTRIES_H_
#define TRAVERSE_ENGINE_COST_ROUTE_ENTRIES_H_

#include "engine/base/budget.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"

namespace traverse {

// A route of up to this many visits is chosen as a whole. Longer windows would take too long
// between two readings of the clock.
inline constexpr int kEntryWindow = 256;

// Chooses the entries of `route`, a valid one, again and keeps its order: exactly (EntryChoice)
// within windows of kEntryWindow visits that overlap by half. Never worse. When the budget runs
// out, the remaining windows stay as they are.
void ChooseEntries(const LayerView& layer, Route& route, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_ROUTE_ENTRIES_H_
