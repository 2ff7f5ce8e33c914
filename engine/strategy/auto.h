// Strategy `auto`: the best route for the given time. The default.
//
// Greedy, then local search over order, entries and directions together, then kicks and repairs
// until they no longer pay (engine/search/). Any plan, any cost.

#ifndef TRAVERSE_ENGINE_STRATEGY_AUTO_H_
#define TRAVERSE_ENGINE_STRATEGY_AUTO_H_

#include "engine/strategy/strategy.h"

namespace traverse {

StrategyEntry AutoEntry();

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_AUTO_H_
