// Delivers a job's answers to its sink, one at a time.

#ifndef TRAVERSE_ENGINE_SCHEDULE_OUTBOX_H_
#define TRAVERSE_ENGINE_SCHEDULE_OUTBOX_H_

#include <deque>
#include <mutex>
#include <utility>

#include "engine/engine.h"

namespace traverse {

// Answers come from several threads, but a sink sees calls that never overlap. Whichever thread
// finds nobody delivering delivers for all of them; none waits. Thread-safe.
class Outbox {
 public:
  explicit Outbox(JobSink& sink) : sink_(sink) {}

  void Deliver(LayerOutcome outcome) {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      waiting_.push_back(std::move(outcome));
    }
    Drain();
  }

  // The last call; what is delivered after it is dropped.
  void Done() {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      done_ = true;
    }
    Drain();
  }

 private:
  void Drain() {
    std::unique_lock<std::mutex> lock(mutex_);
    if (draining_) return;
    draining_ = true;
    while (!waiting_.empty()) {
      LayerOutcome outcome = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      sink_.OnLayer(std::move(outcome));
      lock.lock();
    }
    // After the last call nobody drains again; the sink may be gone.
    draining_ = done_;
    if (!done_) return;
    lock.unlock();
    sink_.OnDone();
  }

  JobSink& sink_;
  std::mutex mutex_;
  std::deque<LayerOutcome> waiting_;
  bool draining_ = false;
  bool done_ = false;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_OUTBOX_H_
