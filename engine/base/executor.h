// Where the engine's work is run. The engine owns no threads: its caller brings them.

#ifndef TRAVERSE_ENGINE_BASE_EXECUTOR_H_
#define TRAVERSE_ENGINE_BASE_EXECUTOR_H_

#include <cstdint>
#include <functional>
#include <utility>

#include "engine/base/turn.h"

namespace traverse {

// Runs tasks, at any later time, on any threads, in any order. Thread-safe. A task never waits for
// another one, so one thread is enough for progress.
class Executor {
 public:
  virtual ~Executor() = default;

  // Runs `task` once. Must not run it before returning.
  virtual void Submit(std::function<void()> task) = 0;

  // The same for one that works on so many points: it may take long, and much memory.
  virtual void SubmitLarge(std::function<void()> task, int64_t /*points*/) {
    Submit(std::move(task));
  }

  // The turn of the task that the calling thread runs; null if it need not give way. Valid until
  // the task ends.
  virtual Turn* turn() { return nullptr; }

  // About how many tasks it runs at once. Nothing but the split of a job's time depends on it.
  virtual int threads() const { return 1; }
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_EXECUTOR_H_
