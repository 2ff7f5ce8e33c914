// How long the work on a file may go on.

#ifndef TRAVERSE_CLIENT_GCODE_WORK_LIMIT_H_
#define TRAVERSE_CLIENT_GCODE_WORK_LIMIT_H_

#include <atomic>
#include <memory>
#include <stop_token>
#include <utility>

#include "absl/status/status.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"

namespace traverse::gcode {

// Loops over a file ask it and return early; what they leave behind is worth nothing, and whoever
// began the work looks at status() before he believes it. Thread-safe; copies end together.
//
//   for (const Visit& visit : layer.visits()) {
//     if (limit.Ended()) return;
//     ... one small step, well under a millisecond ...
//   }
class WorkLimit {
 public:
  // No limit.
  WorkLimit() = default;

  // Ends when `cancel` requests it, or at `until`.
  WorkLimit(absl::Time until, std::stop_token cancel)
      : state_(std::make_shared<State>(until, std::move(cancel))) {}

  // True once the work must end, and from then on.
  bool Ended() const {
    if (state_ == nullptr) return false;
    if (state_->ended.load(std::memory_order_relaxed)) return true;
    if (!state_->cancel.stop_requested() && absl::Now() < state_->until) return false;
    state_->ended.store(true, std::memory_order_relaxed);
    return true;
  }

  // OK if no work has been cut short; otherwise Cancelled or DeadlineExceeded.
  absl::Status status() const {
    if (state_ == nullptr || !state_->ended.load(std::memory_order_relaxed)) {
      return absl::OkStatus();
    }
    return state_->cancel.stop_requested()
               ? absl::CancelledError("cancelled")
               : absl::DeadlineExceededError("the time for this file is over");
  }

 private:
  struct State {
    State(absl::Time until_when, std::stop_token cancelled_by)
        : until(until_when), cancel(std::move(cancelled_by)) {}

    const absl::Time until;
    const std::stop_token cancel;
    std::atomic<bool> ended{false};
  };

  std::shared_ptr<State> state_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WORK_LIMIT_H_
