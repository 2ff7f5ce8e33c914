// Any strategy, asked about costs as they are on ordinary parts only.

#ifndef TRAVERSE_ENGINE_STRATEGY_IN_ORDINARY_UNIT_H_
#define TRAVERSE_ENGINE_STRATEGY_IN_ORDINARY_UNIT_H_

#include <memory>

#include "engine/strategy/strategy.h"

namespace traverse {

// Solves by `strategy`, in the unit of cost/cost_unit.h; solutions are in the problem's own. Routes
// of problems whose costs are ordinary are those of `strategy` itself.
std::unique_ptr<Strategy> InOrdinaryUnit(std::unique_ptr<Strategy> strategy);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_IN_ORDINARY_UNIT_H_
