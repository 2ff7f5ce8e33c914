// Strategy `none`: the given order. SPEC 3.1.

#ifndef TRAVERSE_ENGINE_STRATEGY_NONE_H_
#define TRAVERSE_ENGINE_STRATEGY_NONE_H_

#include "engine/strategy/strategy.h"

namespace traverse {

StrategyEntry NoneEntry();

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_NONE_H_
