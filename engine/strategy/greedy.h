// Strategy `greedy`: always the nearest allowed point. SPEC 3.2.

#ifndef TRAVERSE_ENGINE_STRATEGY_GREEDY_H_
#define TRAVERSE_ENGINE_STRATEGY_GREEDY_H_

#include "engine/strategy/strategy.h"

namespace traverse {

StrategyEntry GreedyEntry();

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_GREEDY_H_
