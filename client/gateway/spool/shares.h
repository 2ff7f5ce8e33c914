// A number of things, of which each caller has a share: half of them, and of the last quarter a
// sixteenth; one at least.

#ifndef TRAVERSE_CLIENT_GATEWAY_SPOOL_SHARES_H_
#define TRAVERSE_CLIENT_GATEWAY_SPOOL_SHARES_H_

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "engine/base/mutex.h"

namespace traverse::gateway {

// Thread-safe.
class Shares {
 public:
  explicit Shares(uint64_t most) : most_(most) {}

  // Why nothing was taken.
  struct Refusal {
    bool of_caller;  // the caller's share is used up; otherwise there are no more at all
    uint64_t most;   // that he, or all together, may have now
  };

  // Takes `count` for `caller`; for the gateway itself if that is empty.
  std::optional<Refusal> Take(uint64_t count, const std::string& caller) {
    MutexLock lock(mutex_);
    if (count > most_ || used_ > most_ - count) return Refusal{false, most_};
    const bool last_quarter = used_ + count > most_ - most_ / 4;
    const uint64_t part = std::max<uint64_t>(1, most_ / (last_quarter ? 16 : 2));
    const uint64_t share = caller.empty() ? most_ : part;
    const auto own = callers_.find(caller);
    if ((own == callers_.end() ? 0 : own->second) + count > share) return Refusal{true, share};
    used_ += count;
    callers_[caller] += count;
    return std::nullopt;
  }

  // REQUIRES: `caller` has taken as many.
  void GiveBack(uint64_t count, const std::string& caller) {
    MutexLock lock(mutex_);
    const auto own = callers_.find(caller);
    assert(count == 0 || (own != callers_.end() && own->second >= count));
    used_ -= count;
    if (own != callers_.end() && (own->second -= count) == 0) callers_.erase(own);
  }

  uint64_t used() const {
    MutexLock lock(mutex_);
    return used_;
  }
  uint64_t most() const { return most_; }

 private:
  const uint64_t most_;
  mutable Mutex mutex_;
  uint64_t used_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  std::map<std::string, uint64_t> callers_ TRAVERSE_GUARDED_BY(mutex_);  // used by each
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_SPOOL_SHARES_H_
