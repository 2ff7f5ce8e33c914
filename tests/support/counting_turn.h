// How often a piece of work asks its budget.

#ifndef TRAVERSE_TESTS_SUPPORT_COUNTING_TURN_H_
#define TRAVERSE_TESTS_SUPPORT_COUNTING_TURN_H_

#include <functional>
#include <optional>

#include "engine/base/budget.h"
#include "engine/base/turn.h"

namespace traverse::testing {

// Wanted all the time; counts how often it is asked to give travel.
class CountingTurn : public Turn {
 public:
  CountingTurn() { SetWanted(true); }
  bool GiveWay(const CancelToken* /*cancel*/, std::optional<Clock::time_point> /*end*/) override {
    ++asks;
    return false;
  }
  int asks = 0;
};

// How often `work` asks the budget that it is given, which has no limit.
inline int AsksOf(const std::function<void(Budget&)>& work) {
  CountingTurn turn;
  Budget budget(nullptr, std::nullopt, &turn);
  work(budget);
  return turn.asks;
}

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_COUNTING_TURN_H_
