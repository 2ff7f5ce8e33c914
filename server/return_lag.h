// How long results take from the end of the search to the end of the call: measured, so that
// deadlines are also kept where the machine is busy or the callers' connections are slow.

#ifndef TRAVERSE_SERVER_RETURN_LAG_H_
#define TRAVERSE_SERVER_RETURN_LAG_H_

#include <mutex>

#include "engine/base/budget.h"

namespace traverse {

// Thread-safe.
class ReturnLag {
 public:
  using Duration = Budget::Clock::duration;

  // A call whose search was ended by its deadline ended `lag` later.
  void Record(Duration lag) {
    std::lock_guard<std::mutex> lock(mutex_);
    // Up at once, down slowly: a deadline that is missed costs more than a search that is shorter.
    lag_ = lag > lag_ ? lag : lag_ + (lag - lag_) / kFadingCalls;
  }

  // The time that should be left to the way back.
  Duration Margin() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return lag_ + lag_ / 2;
  }

 private:
  static constexpr int kFadingCalls = 10;

  mutable std::mutex mutex_;
  Duration lag_{};
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RETURN_LAG_H_
