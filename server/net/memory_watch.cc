#include "server/net/memory_watch.h"

#include <malloc.h>

#include <utility>

#include "server/ops/memory.h"

namespace traverse {
namespace {

// How often to check memory, and the shares of the limit from which it is short, and connections
// are cut.
constexpr auto kLookEvery = std::chrono::milliseconds(10);
constexpr double kShortShare = 0.7;
constexpr double kCutShare = 0.78;

// The allocator keeps much of what is freed, which is no reason to refuse anybody: from this share
// on, what it keeps is given back if it is at least the second share, at most that often.
constexpr double kTrimShare = 0.5;
constexpr double kGarbageShare = 0.1;
constexpr auto kTrimEvery = std::chrono::seconds(1);
constexpr auto kTrimEveryWhileShort = std::chrono::milliseconds(200);

}  // namespace

MemoryWatch::MemoryWatch(int64_t max_memory, Connections* connections, Hooks hooks)
    : max_memory_(max_memory),
      connections_(connections),
      hooks_(std::move(hooks)),
      watch_(kLookEvery, [this] { Look(); }) {}

double MemoryWatch::Share() const {
  return static_cast<double>(ResidentBytes()) / static_cast<double>(max_memory_);
}

bool MemoryWatch::GiveGarbageBack(double share) {
  if (share <= kTrimShare) return false;
  const auto now = std::chrono::steady_clock::now();
  const auto pause =
      share > kShortShare ? std::chrono::nanoseconds(kTrimEveryWhileShort) : kTrimEvery;
  if (now - trimmed_ <= pause) return false;
  trimmed_ = now;
  const auto garbage = static_cast<double>(mallinfo2().fordblks);
  if (garbage < kGarbageShare * static_cast<double>(max_memory_)) return false;
  malloc_trim(0);
  return true;
}

void MemoryWatch::Look() {
  double share = Share();
  if (GiveGarbageBack(share)) share = Share();
  hooks_.set_short(share > kShortShare);
  if (share <= kCutShare || connections_ == nullptr) return;
  if (connections_->CutLargest()) hooks_.on_cut();
}

}  // namespace traverse
