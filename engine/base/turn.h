// How tasks that share a processor take turns.

#ifndef TRAVERSE_ENGINE_BASE_TURN_H_
#define TRAVERSE_ENGINE_BASE_TURN_H_

#include <atomic>
#include <chrono>
#include <optional>

namespace traverse {

// A wish to stop, shared by everything that works on one job. Thread-safe.
class CancelToken {
 public:
  void Cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> cancelled_{false};
};

// A task that may take long calls wanted() again and again, as every Budget does, and yields when
// it returns true. So others need not wait for its end. Results do not depend on it.
class Turn {
 public:
  virtual ~Turn() = default;

  // Whether others wait, or somebody checks that the task is alive. Any thread may ask.
  bool wanted() const { return wanted_.load(std::memory_order_relaxed); }

  // Lets others run. Returns when it is the task's turn again, soon after `cancel` (may be null)
  // was cancelled, or at `deadline`. Returns whether it had to wait. REQUIRES: the calling thread
  // runs the task and holds no lock.
  using Clock = std::chrono::steady_clock;
  virtual bool GiveWay(const CancelToken* cancel, std::optional<Clock::time_point> deadline) = 0;

 protected:
  void SetWanted(bool wanted) { wanted_.store(wanted, std::memory_order_relaxed); }

 private:
  std::atomic<bool> wanted_{false};
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_TURN_H_
