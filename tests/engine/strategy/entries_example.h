// The strategy that engine/README.md adds as an example.

#ifndef TRAVERSE_TESTS_ENGINE_STRATEGY_ENTRIES_EXAMPLE_H_
#define TRAVERSE_TESTS_ENGINE_STRATEGY_ENTRIES_EXAMPLE_H_

#include "engine/strategy/strategy.h"

namespace traverse {

StrategyEntry EntriesEntry();

}  // namespace traverse

#endif  // TRAVERSE_TESTS_ENGINE_STRATEGY_ENTRIES_EXAMPLE_H_
