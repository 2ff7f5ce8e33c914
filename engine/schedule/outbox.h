// Delivers a job's answers to its sink, one at a time.

#ifndef TRAVERSE_ENGINE_SCHEDULE_OUTBOX_H_
#define TRAVERSE_ENGINE_SCHEDULE_OUTBOX_H_

#include <deque>
#include <optional>
#include <utility>

#include "engine/base/mutex.h"
#include "engine/engine.h"

namespace traverse {

// Answers come from several threads, but a sink must see calls that never overlap. A thread that
// finds nobody delivering delivers for all of them; none waits. Thread-safe.
class Outbox {
 public:
  explicit Outbox(JobSink& sink) : sink_(sink) {}

  void Deliver(LayerOutcome outcome) {
    {
      MutexLock lock(mutex_);
      waiting_.push_back(std::move(outcome));
    }
    Drain();
  }

  // The last call. Whatever is delivered after it is dropped. `chain_bound`: of all layers
  // together, if it is known.
  void Done(std::optional<double> chain_bound) {
    {
      MutexLock lock(mutex_);
      done_ = true;
      chain_bound_ = chain_bound;
    }
    Drain();
  }

 private:
  void Drain() {
    MutexLock lock(mutex_);
    if (draining_) return;
    draining_ = true;
    while (!waiting_.empty()) {
      LayerOutcome outcome = std::move(waiting_.front());
      waiting_.pop_front();
      lock.Unlock();
      sink_.OnLayer(std::move(outcome));
      lock.Lock();
    }
    // After the last call nobody delivers again; the sink may be gone.
    draining_ = done_;
    if (!done_) return;
    lock.Unlock();
    if (chain_bound_) sink_.OnChainBound(*chain_bound_);
    sink_.OnDone();
  }

  JobSink& sink_;
  Mutex mutex_;
  std::deque<LayerOutcome> waiting_ TRAVERSE_GUARDED_BY(mutex_);
  bool draining_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool done_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::optional<double> chain_bound_;  // does not change any more once `done_` is set
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_OUTBOX_H_
