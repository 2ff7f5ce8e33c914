// Wraps any strategy so that it only sees costs of ordinary magnitude.

#ifndef TRAVERSE_ENGINE_STRATEGY_IN_ORDINARY_UNIT_H_
#define TRAVERSE_ENGINE_STRATEGY_IN_ORDINARY_UNIT_H_

#include <memory>

#include "engine/strategy/strategy.h"

namespace traverse {

// Solves with `strategy`, in the unit of cost/cost_unit.h. Solutions are in the problem's own unit.
// If a problem's costs are ordinary, the routes are those of `strategy` itself.
std::unique_ptr<Strategy> InOrdinaryUnit(std::unique_ptr<Strategy> strategy);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_IN_ORDINARY_UNIT_H_
