// The threads that do the work of all jobs: a fixed number, shared fairly.
//
// Fair means by time of the threads, on two levels: the caller who had least is next, and of his
// jobs the one that had least (fair_order.h). What comes new has a head start: a job of one layer
// waits for a task under way to end and is then done at one go, however long the queues of the
// others are.
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
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/executor.h"
#include "server/fair_order.h"

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

  // The time in seconds that the calling thread has worked.
  using WorkClock = std::function<double()>;
  static double ThreadCpuSeconds();

  // Starts `threads` threads, at least one. `clock` says what tasks are charged. The threads are
  // nicer by `nice` than the one that calls.
  explicit WorkerPool(int threads, WorkClock clock = ThreadCpuSeconds, int nice = 0);

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

  // A caller with queues whose tasks wait or run.
  struct Caller : FairOrder::Member {
    FairOrder turns;
    int queues = 0;
  };

  // REQUIRES, of all but RunTasks: mutex_ is held.
  void Submit(const std::shared_ptr<QueueImpl>& queue, std::function<void()> run);
  void Enter(QueueImpl& queue);
  void LeaveIfIdle(QueueImpl& queue);
  Task TakeNext();  // REQUIRES: a task waits
  void EndTask(const Task& task, double wall_seconds, double work_seconds);
  void RunTasks();

  const WorkClock clock_;
  mutable std::mutex mutex_;
  std::condition_variable work_;
  std::map<std::string, Caller> callers_;  // those with tasks
  FairOrder turns_;                        // of callers
  int64_t waiting_ = 0;
  int busy_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_WORKER_POOL_H_
