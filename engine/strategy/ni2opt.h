// Strategy `ni2opt`: nearest insertion, 2-opt and point release. SPEC 3.3 and 3.4.

#ifndef TRAVERSE_ENGINE_STRATEGY_NI2OPT_H_
#define TRAVERSE_ENGINE_STRATEGY_NI2OPT_H_

#include "engine/strategy/strategy.h"

namespace traverse {

StrategyEntry Ni2optEntry();

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_NI2OPT_H_
