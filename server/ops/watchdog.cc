#include "server/ops/watchdog.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace traverse {
namespace {

constexpr absl::Duration kLongestPeriod = absl::Seconds(1);
constexpr absl::Duration kShortestPeriod = absl::Milliseconds(1);

}  // namespace

Watchdog::Watchdog(WorkerPool& pool, absl::Duration limit,
                   std::function<void(const SilentTask&)> on_silent)
    : pool_(pool),
      limit_(limit),
      on_silent_(std::move(on_silent)),
      looks_(absl::ToChronoNanoseconds(std::clamp(limit / 4, kShortestPeriod, kLongestPeriod)),
             [this] { Look(); }) {}

void Watchdog::Look() {
  const std::vector<SilentTask> silent = pool_.Silent(absl::ToChronoNanoseconds(limit_));
  std::set<std::string> still;
  for (const SilentTask& task : silent) {
    if (reported_.count(task.job) == 0) on_silent_(task);
    still.insert(task.job);
  }
  reported_ = std::move(still);
  silent_ = static_cast<int>(silent.size());
}

}  // namespace traverse
