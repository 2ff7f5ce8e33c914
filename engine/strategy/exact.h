// Strategy `exact`: routes with a proof.

#ifndef TRAVERSE_ENGINE_STRATEGY_EXACT_H_
#define TRAVERSE_ENGINE_STRATEGY_EXACT_H_

#include "engine/strategy/strategy.h"

namespace traverse {

StrategyEntry ExactEntry();

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_EXACT_H_
