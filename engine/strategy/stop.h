// Why a strategy's search ended.

#ifndef TRAVERSE_ENGINE_STRATEGY_STOP_H_
#define TRAVERSE_ENGINE_STRATEGY_STOP_H_

#include "engine/base/budget.h"
#include "engine/model/route.h"

namespace traverse {

// kCancelled or kTimeLimit if the budget cut the search short, else `otherwise`.
inline StopReason StopOr(const Budget& budget, StopReason otherwise) {
  if (!budget.was_exhausted()) return otherwise;
  return budget.cancelled() ? StopReason::kCancelled : StopReason::kTimeLimit;
}

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_STOP_H_
