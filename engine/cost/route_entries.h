// The entries of a given route, chosen again.

#ifndef TRAVERSE_ENGINE_COST_ROUTE_ENTRIES_H_
#define TRAVERSE_ENGINE_COST_ROUTE_ENTRIES_H_

#include "engine/base/budget.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"

namespace traverse {

// A route of up to so many visits is chosen as a whole; more of them would be too many between two
// looks at the clock.
inline constexpr int kEntryWindow = 256;

// Chooses the entries of `route`, a valid one, again, its order kept: exactly (EntryChoice) within
// windows of kEntryWindow visits that overlap by half. Never worse. When the budget runs out, the
// windows that are left stay as they are.
void ChooseEntries(const LayerView& layer, Route& route, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_ROUTE_ENTRIES_H_
