// Strategy `tabu`: the thesis's framework with tabu search, and cures of its known faults. SPEC
// 3.5; engine/TABU.md has results.

#ifndef TRAVERSE_ENGINE_STRATEGY_TABU_H_
#define TRAVERSE_ENGINE_STRATEGY_TABU_H_

#include "engine/strategy/strategy.h"

namespace traverse {

StrategyEntry TabuEntry();

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_TABU_H_
