// Where the engine's work runs. The engine owns no threads; its caller brings them.

#ifndef TRAVERSE_ENGINE_BASE_EXECUTOR_H_
#define TRAVERSE_ENGINE_BASE_EXECUTOR_H_

#include <cstdint>
#include <functional>
#include <utility>

#include "engine/base/turn.h"

namespace traverse {

// Runs tasks at any later time, on any threads, in any order. Thread-safe. No task waits for
// another, so one thread is enough for progress.
class Executor {
 public:
  virtual ~Executor() = default;

  // Runs `task` once, but not before this call returns.
  virtual void Submit(std::function<void()> task) = 0;

  // The same for a task that works on `points` points: it may take long and need much memory. Of
  // the tasks that wait, one of a lower `rank` had better begin first: others depend on it.
  virtual void SubmitLarge(std::function<void()> task, int64_t /*points*/, uint64_t /*rank*/ = 0) {
    Submit(std::move(task));
  }

  // The turn of the task that the calling thread runs; null if it need not yield. Valid until the
  // task ends.
  virtual Turn* turn() { return nullptr; }

  // About how many tasks run at once. Only the division of a job's time depends on it.
  virtual int threads() const { return 1; }
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_EXECUTOR_H_
