// The threads that do the work of all jobs, shared fairly.
//
// As many tasks work at a time as there are processors; each of these has a permit. Fair means by
// time worked, on two levels: the next is the caller that has had the least, and among that
// caller's jobs the one that has had the least (fair_order.h). New work has a head start.
//
// A job may state when it is due: from then on its tasks are quick, because they only return what
// there is, and somebody waits for it. So due jobs go before all others, among them again the
// caller that has had the least, and of its jobs the one that was due first.
//
// A long task gives its permit up to waiting ones after each kSlice of its work, wherever it asks
// its budget (engine/base/turn.h), and continues in its thread when its turn comes again. So a job
// of one small layer is answered whatever the others do. And there are more threads than permits:
// one for each task in progress.
//
//   WorkerPool pool(2);
//   auto queue = pool.NewQueue("10.0.0.7");      // one for each job
//   auto job = Job::Start(spec, strategy, *queue, sink);
//
// Knows nothing of gRPC, so that it can be tested under ThreadSanitizer.

#ifndef TRAVERSE_SERVER_JOBS_WORKER_POOL_H_
#define TRAVERSE_SERVER_JOBS_WORKER_POOL_H_

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/executor.h"
#include "engine/base/mutex.h"
#include "server/jobs/fair_order.h"

namespace traverse {

// How long the tasks of one queue waited for a thread.
struct QueueWait {
  int64_t tasks = 0;           // number of tasks begun so far
  double first_seconds = 0;    // of the first task
  double longest_seconds = 0;  // of any task
};

// A task that was asked for a sign of life and gave none.
struct SilentTask {
  std::string caller;
  std::string job;
  double seconds = 0;  // since the last sign
};

// Thread-safe.
class WorkerPool {
 public:
  // The engine's view of the pool for one job. Thread-safe. Tasks that still wait when the queue is
  // destroyed run nevertheless.
  class Queue : public Executor {
   public:
    virtual QueueWait wait() const = 0;

    // Time that threads spent on tasks of this queue, up to their last pause or their end.
    virtual double busy_seconds() const = 0;

    // Whether no task of this queue waits or is in progress.
    virtual bool idle() const = 0;

    // From `due` on, what the tasks of this queue still have to do is quick.
    virtual void set_due(std::chrono::steady_clock::time_point due) = 0;

    // The job's name, for SilentTask.
    virtual void set_job(const std::string& job) = 0;
  };

  // The time in seconds that the calling thread has worked.
  using WorkClock = std::function<double()>;
  static double ThreadCpuSeconds();

  // How long a task works before it yields, if others wait.
  static constexpr std::chrono::milliseconds kSlice{10};

  // Tasks that may be in progress at a time, including paused ones. Tasks of more than kSmallPoints
  // points hold memory while paused: so the large ones together, and the medium ones together, may
  // be in progress with at most this many points, or fewer after LimitMemory. In any case as many
  // tasks as there are permits may be in progress.
  static constexpr size_t kMostUnderWay = 512;
  static constexpr int64_t kSmallPoints = 64;
  static constexpr int64_t kLargePoints = 20'000;
  static constexpr int64_t kMostPoints = 4'000'000;

  // Memory that a search may hold per point, in bytes, in addition to the layer. Measured on 20,000
  // contours of one point: tabu 3,000, `exact` 900, `auto` 800. The bound of `auto` takes most: on
  // 80 contours of 12 points 16,000.
  static constexpr int64_t kBytesOfPoint = 16'000;

  // `permits` tasks work at a time, at least one. `clock` measures what they are charged. Adds
  // `nice` to the workers' nice value, relative to the calling thread.
  explicit WorkerPool(int permits, WorkClock clock = ThreadCpuSeconds, int nice = 0);

  // Runs what is queued, then ends the threads. REQUIRES: no queue is used any more, except by
  // tasks of the pool.
  ~WorkerPool();

  // A caller with weight 2 has twice the time of one without, which has 1. REQUIRES: no queue was
  // made; weights above 0.
  void SetWeights(std::map<std::string, double> weights) { weights_ = std::move(weights); }

  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // A queue for one job of `caller`. May outlive its last task, but not the pool. Calls
  // `on_no_memory` when a task ended with std::bad_alloc: the one job that wants too much ends, not
  // the process.
  std::shared_ptr<Queue> NewQueue(const std::string& caller,
                                  std::function<void()> on_no_memory = {});

  // Searches in progress may hold `bytes`, half for those of large layers and half for the others.
  void LimitMemory(int64_t bytes);

  // While memory is short, no task that holds much begins beyond the permits: those in progress end
  // first.
  void SetMemoryShort(bool is_short);

  // How many tasks work at a time.
  int threads() const { return permits_; }

  // Number of threads: one for each task in progress, and some idle ones.
  size_t thread_count() const;

  // Tasks that work now.
  int busy() const;

  // Tasks that wait now, to begin or to continue.
  int64_t waiting() const;

  // The working tasks that gave no sign of life for longer than `limit`. Asks all of them for one,
  // which those that ask their budgets give at once. Call it regularly, more often than each
  // `limit`.
  std::vector<SilentTask> Silent(std::chrono::nanoseconds limit);

 private:
  using Clock = std::chrono::steady_clock;

  class QueueImpl;
  class Worker;

  struct Task {
    std::function<void()> run;
    Clock::time_point submitted;
    int64_t points = 0;
    uint64_t rank = 0;
    std::shared_ptr<QueueImpl> queue = nullptr;  // which lives as long as its tasks

    bool small() const { return points <= kSmallPoints; }
    bool large() const { return points > kLargePoints; }
  };

  // Queues that wait, and when they are due; without those that never are.
  using ByDue = std::set<std::pair<Clock::time_point, QueueImpl*>>;

  // A caller with queues whose tasks wait or are in progress.
  struct Caller : FairOrder::Member {
    FairOrder turns;
    ByDue by_due;  // of those that wait
    int queues = 0;
  };

  void Submit(const std::shared_ptr<QueueImpl>& queue, Task task) TRAVERSE_EXCLUDES(mutex_);
  void Enter(QueueImpl& queue) TRAVERSE_REQUIRES(mutex_);
  void LeaveIfIdle(QueueImpl& queue) TRAVERSE_REQUIRES(mutex_);

  // Lets `queue` wait for its turn, if it has work.
  void LetWait(QueueImpl& queue) TRAVERSE_REQUIRES(mutex_);

  // The opposite: if it has no more work; and in any case.
  void WithdrawIfNothing(QueueImpl& queue) TRAVERSE_REQUIRES(mutex_);
  void Withdraw(QueueImpl& queue) TRAVERSE_REQUIRES(mutex_);

  void SetDue(QueueImpl& queue, Clock::time_point due) TRAVERSE_EXCLUDES(mutex_);

  // Notes that `queue` waits, or no longer does.
  void AddToDue(QueueImpl& queue) TRAVERSE_REQUIRES(mutex_);
  void TakeFromDue(QueueImpl& queue) TRAVERSE_REQUIRES(mutex_);

  // The queue whose turn it is; null if none of those that wait may continue.
  QueueImpl* TakeNext() TRAVERSE_REQUIRES(mutex_);
  QueueImpl& TakeFirst() TRAVERSE_REQUIRES(mutex_);
  bool MayBegin(const Task& task) const TRAVERSE_REQUIRES(mutex_);

  // The points in progress of tasks of the same size; null for small ones, which are not counted.
  int64_t* PointsUnderWay(const Task& task) TRAVERSE_REQUIRES(mutex_);

  // Gives free permits to those whose turn it is.
  void Dispatch() TRAVERSE_REQUIRES(mutex_);
  bool Begin(QueueImpl& queue) TRAVERSE_REQUIRES(mutex_);
  void TellWorkers() TRAVERSE_REQUIRES(mutex_);

  // Whether a job that waits is due, and was so before the one that `worker` works on. Quick.
  bool IsDueBefore(Clock::time_point now, const Worker& worker) const;

  void Charge(Worker& worker) TRAVERSE_REQUIRES(mutex_);
  bool Pause(Worker& worker) TRAVERSE_EXCLUDES(mutex_);
  void WaitForTurn(Worker& worker) TRAVERSE_REQUIRES(mutex_);
  void EndTask(Worker& worker) TRAVERSE_REQUIRES(mutex_);
  void ReleaseHeldBack() TRAVERSE_REQUIRES(mutex_);

  bool AddThread() TRAVERSE_REQUIRES(mutex_);
  bool RetireIfTooMany(Worker& worker) TRAVERSE_REQUIRES(mutex_);
  void Run(Worker& worker) TRAVERSE_EXCLUDES(mutex_);
  void RunTasks(Worker& worker);
  Worker* WorkerOfThisThread() const TRAVERSE_EXCLUDES(mutex_);

  double WeightOf(const std::string& caller) const;

  const WorkClock clock_;
  std::map<std::string, double> weights_;  // by caller
  const int permits_;
  const int nice_;  // of its threads
  mutable Mutex mutex_;
  ConditionVariable work_;
  std::map<std::string, Caller> callers_ TRAVERSE_GUARDED_BY(mutex_);  // those with tasks
  FairOrder turns_ TRAVERSE_GUARDED_BY(mutex_);                        // of callers
  std::deque<std::shared_ptr<QueueImpl>> held_back_ TRAVERSE_GUARDED_BY(mutex_);  // MayBegin: no
  std::deque<Task> handed_out_ TRAVERSE_GUARDED_BY(mutex_);  // with a permit, for idle threads
  ByDue by_due_ TRAVERSE_GUARDED_BY(mutex_);
  std::atomic<Clock::time_point> next_due_{Clock::time_point::max()};  // first of by_due_
  int64_t waiting_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int busy_ TRAVERSE_GUARDED_BY(mutex_) = 0;               // permits in use
  size_t under_way_ TRAVERSE_GUARDED_BY(mutex_) = 0;       // tasks begun and not ended
  int64_t middle_points_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // of tasks under way that are neither
  int64_t large_points_ TRAVERSE_GUARDED_BY(mutex_) = 0;   // small nor large, and of large ones
  int64_t most_points_ TRAVERSE_GUARDED_BY(mutex_) = kMostPoints;  // of either
  bool memory_short_ TRAVERSE_GUARDED_BY(mutex_) = false;
  size_t idle_ TRAVERSE_GUARDED_BY(mutex_) = 0;     // threads without a task
  size_t looking_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // of these awake, about to look for a task
  bool stopping_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::vector<std::unique_ptr<Worker>> workers_ TRAVERSE_GUARDED_BY(mutex_);
  std::vector<std::unique_ptr<Worker>> retired_ TRAVERSE_GUARDED_BY(mutex_);  // to be joined
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_WORKER_POOL_H_
