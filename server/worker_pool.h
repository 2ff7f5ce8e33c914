// The threads that do the work of all jobs: a fixed number, shared fairly.
//
// Fair means turn by turn on two levels: the callers that have work take turns, and so do the jobs
// of one caller. A job of one layer therefore waits for the tasks under way and for one task of
// every other caller at most, however long the queues of the others are.
//
//   WorkerPool pool(2);
//   auto queue = pool.NewQueue("10.0.0.7");      // one for each job
//   auto job = Job::Start(spec, strategy, *queue, sink);
//
// Knows nothing of gRPC, so that it can be tested under ThreadSanitizer.

#ifndef TRAVERSE_SERVER_WORKER_POOL_H_
#define TRAVERSE_SERVER_WORKER_POOL_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/executor.h"

namespace traverse {

// How long the tasks of one queue waited for a thread.
struct QueueWait {
  int64_t tasks = 0;           // begun so far
  double first_seconds = 0;    // of the first task
  double longest_seconds = 0;  // of any task
};

// Thread-safe.
class WorkerPool {
 public:
  // The engine's view of the pool for one job. Thread-safe. Tasks that are still waiting when the
  // queue is destroyed are run all the same.
  class Queue : public Executor {
   public:
    virtual QueueWait wait() const = 0;

    // Time that threads spent on tasks of this queue that have ended.
    virtual double busy_seconds() const = 0;

    // Whether no task of this queue waits or runs.
    virtual bool idle() const = 0;
  };

  // Starts `threads` threads, at least one.
  explicit WorkerPool(int threads);

  // Runs what is queued, then ends the threads. REQUIRES: no queue is used any more, except by
  // tasks of the pool.
  ~WorkerPool();

  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // A queue for one job of `caller`. May outlive its last task, not the pool. `on_no_memory` is
  // called when a task has ended with std::bad_alloc: one job that wants too much ends, not the
  // process.
  std::shared_ptr<Queue> NewQueue(const std::string& caller,
                                  std::function<void()> on_no_memory = {});

  int threads() const { return static_cast<int>(threads_.size()); }

  // Threads that are running a task now.
  int busy() const;

  // Tasks that wait for a thread now.
  int64_t waiting() const;

 private:
  using Clock = std::chrono::steady_clock;

  class QueueImpl;

  struct Task {
    std::function<void()> run;
    Clock::time_point submitted;
    std::shared_ptr<QueueImpl> queue = nullptr;  // from TakeNext on
  };

  // The queues of one caller that have tasks, in the order of their turns.
  struct Caller {
    std::string name;
    std::deque<std::shared_ptr<QueueImpl>> turns;
  };

  void Submit(const std::shared_ptr<QueueImpl>& queue, std::function<void()> run);
  Task TakeNext();  // REQUIRES: mutex_ is held and a task waits
  void RunTasks();

  mutable std::mutex mutex_;
  std::condition_variable work_;
  std::list<Caller> callers_;  // those that have tasks, in the order of their turns
  std::map<std::string, std::list<Caller>::iterator> caller_by_name_;
  int64_t waiting_ = 0;
  int busy_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_WORKER_POOL_H_
