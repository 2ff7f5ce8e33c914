// The budget of a search: a deadline and a cancellation, asked in inner loops.

#ifndef TRAVERSE_ENGINE_BASE_BUDGET_H_
#define TRAVERSE_ENGINE_BASE_BUDGET_H_

#include <chrono>
#include <optional>

#include "engine/base/turn.h"

namespace traverse {

// How long a search may go on. One object for each search: not thread-safe, but the token that it
// watches is. The engine sees no clock but this one.
//
//   Budget budget(&token, deadline);
//   while (!budget.Exhausted()) { ... one small step, well under 10 ms ... }
class Budget {
 public:
  using Clock = std::chrono::steady_clock;

  // Without a limit.
  Budget() = default;

  // Ends when `cancel` is cancelled, or at `deadline`. Whoever asks it gives way when `turn` is
  // wanted. Both may be null; not owned, they outlive the budget.
  explicit Budget(const CancelToken* cancel,
                  std::optional<Clock::time_point> deadline = std::nullopt, Turn* turn = nullptr)
      : cancel_(cancel), turn_(turn), deadline_(deadline) {}

  // True once the search has to return what it has; stays true then. Cheap: the cancellation and
  // the turn are looked at every time, the clock only every kCallsPerClockReading calls.
  bool Exhausted() {
    if (exhausted_) return LeaveTurn();
    if (turn_ != nullptr && turn_->wanted() && turn_->GiveWay(cancel_, deadline_)) {
      calls_to_clock_ = 1;
    }
    if (cancel_ != nullptr && cancel_->cancelled()) return exhausted_ = true;
    if (!deadline_ || --calls_to_clock_ > 0) return false;
    calls_to_clock_ = kCallsPerClockReading;
    return exhausted_ = Clock::now() >= *deadline_;
  }

  // Same, but always looks at the clock. For steps that are slow themselves.
  bool ExhaustedNow() {
    calls_to_clock_ = 1;
    return Exhausted();
  }

  // True if Exhausted() has said so: the search was cut short. Does not look again, so a search
  // that ended by itself is not taken for one that its deadline ended.
  bool was_exhausted() const { return exhausted_; }

  // True if the end was, or would now be, for the cancellation and not for the clock.
  bool cancelled() const { return cancel_ != nullptr && cancel_->cancelled(); }

  // The cancellation watched, or null; for budgets derived from this one.
  const CancelToken* cancel() const { return cancel_; }

  std::optional<Clock::time_point> deadline() const { return deadline_; }

  // A budget that ends with this one, or after `limit` from now if that is earlier.
  Budget Within(Clock::duration limit) const {
    const Clock::time_point end = Clock::now() + limit;
    return Budget(cancel_, deadline_ && *deadline_ < end ? *deadline_ : end, turn_);
  }

 private:
  // Nobody waits for what was cancelled: what is still to be done of it lets others on. True.
  bool LeaveTurn() {
    if (turn_ != nullptr && turn_->wanted() && cancelled()) turn_->GiveWay(nullptr, std::nullopt);
    return true;
  }

  static constexpr int kCallsPerClockReading = 4;

  const CancelToken* cancel_ = nullptr;
  Turn* turn_ = nullptr;
  std::optional<Clock::time_point> deadline_;
  int calls_to_clock_ = 1;
  bool exhausted_ = false;
};

// Measures how long something took. Kept here, as the engine's other use of the clock.
class Stopwatch {
 public:
  double Seconds() const {
    return std::chrono::duration<double>(Budget::Clock::now() - begin_).count();
  }

 private:
  Budget::Clock::time_point begin_ = Budget::Clock::now();
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_BUDGET_H_
