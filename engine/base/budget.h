// The budget of a search: a deadline and a cancellation, checked in inner loops.

#ifndef TRAVERSE_ENGINE_BASE_BUDGET_H_
#define TRAVERSE_ENGINE_BASE_BUDGET_H_

#include <chrono>
#include <optional>

#include "engine/base/turn.h"

namespace traverse {

// Tells the time. Tests have one of their own, which does not depend on the machine.
class TimeSource {
 public:
  virtual ~TimeSource() = default;
  virtual std::chrono::steady_clock::time_point Now() const = 0;
};

// Says how long a search may continue. Each search has its own object, which is not thread-safe;
// the token that it watches is. The engine has no other clock.
//
//   Budget budget(&token, deadline);
//   while (!budget.Exhausted()) { ... one small step, well under 10 ms ... }
class Budget {
 public:
  using Clock = std::chrono::steady_clock;

  // No limit.
  Budget() = default;

  // Ends when `cancel` is cancelled, or at `deadline` by `time` (null: the steady clock). A thread
  // that asks this budget yields when others want `turn`. All three may be null; the caller owns
  // them, and they outlive the budget.
  explicit Budget(const CancelToken* cancel,
                  std::optional<Clock::time_point> deadline = std::nullopt, Turn* turn = nullptr,
                  const TimeSource* time = nullptr)
      : cancel_(cancel), turn_(turn), time_(time), deadline_(deadline) {}

  static Clock::time_point Now(const TimeSource* time) {
    return time != nullptr ? time->Now() : Clock::now();
  }

  // True once the search must return what it has, and from then on. Cheap: each call checks the
  // cancellation and the turn, but reads the clock only every kCallsPerClockReading calls.
  bool Exhausted() {
    if (exhausted_) return LeaveTurn();
    if (turn_ != nullptr && turn_->wanted() && turn_->GiveWay(cancel_, deadline_)) {
      calls_to_clock_ = 1;
    }
    if (cancel_ != nullptr && cancel_->cancelled()) return exhausted_ = true;
    if (!deadline_ || --calls_to_clock_ > 0) return false;
    calls_to_clock_ = kCallsPerClockReading;
    return exhausted_ = Now(time_) >= *deadline_;
  }

  // The same, but always reads the clock. For steps that are slow themselves.
  bool ExhaustedNow() {
    calls_to_clock_ = 1;
    return Exhausted();
  }

  // True if Exhausted() has returned true, so the search was cut short. Does not check again, so a
  // search that ended by itself does not count as ended by its deadline.
  bool was_exhausted() const { return exhausted_; }

  // True if the budget ended, or would end now, because of the cancellation and not the clock.
  bool cancelled() const { return cancel_ != nullptr && cancel_->cancelled(); }

  // The cancellation watched, or null; for budgets derived from this one.
  const CancelToken* cancel() const { return cancel_; }

  std::optional<Clock::time_point> deadline() const { return deadline_; }

  // A budget that ends with this one, or after `limit` from now if that is earlier.
  Budget Within(Clock::duration limit) const {
    const Clock::time_point end = Now(time_) + limit;
    return Budget(cancel_, deadline_ && *deadline_ < end ? *deadline_ : end, turn_, time_);
  }

  // A budget with that share of the time that is left; this one if it has no deadline.
  Budget WithShare(double share) const {
    if (!deadline_) return *this;
    return Within(std::chrono::duration_cast<Clock::duration>((*deadline_ - Now(time_)) * share));
  }

 private:
  // Yields, so that cancelled work that must still finish delays nobody. Returns true.
  bool LeaveTurn() {
    if (turn_ != nullptr && turn_->wanted() && cancelled()) turn_->GiveWay(nullptr, std::nullopt);
    return true;
  }

  static constexpr int kCallsPerClockReading = 4;

  const CancelToken* cancel_ = nullptr;
  Turn* turn_ = nullptr;
  const TimeSource* time_ = nullptr;
  std::optional<Clock::time_point> deadline_;
  int calls_to_clock_ = 1;
  bool exhausted_ = false;
};

// Measures elapsed time. It is here because it is the engine's only other use of the clock.
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
