// The parts of a WorkerPool; only for its sources.

#ifndef TRAVERSE_SERVER_JOBS_WORKER_POOL_PARTS_H_
#define TRAVERSE_SERVER_JOBS_WORKER_POOL_PARTS_H_

#include <atomic>
#include <cassert>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "server/jobs/worker_pool.h"

namespace traverse {

// A thread, and the turn of the task that it runs. The pool's mutex guards it, except what only the
// thread uses.
class WorkerPool::Worker : public Turn {
 public:
  explicit Worker(WorkerPool& pool) : pool_(pool) {}

  // While others wait, GiveWay is called wherever a search asks its budget, often each microsecond.
  // After calls in such quick succession it skips the clock for this many of them.
  static constexpr std::chrono::microseconds kQuick{100};
  static constexpr int kQuickCalls = 8;

  // Quick while its slice lasts.
  bool GiveWay(const CancelToken* cancel, std::optional<Clock::time_point> deadline) override {
    assert(works && std::this_thread::get_id() == id);
    if (--calls_to_clock > 0) return false;
    const Clock::time_point now = Clock::now();
    calls_to_clock = now - looked_at_clock < kQuick ? kQuickCalls : 1;
    looked_at_clock = now;
    heard_of.store(now, std::memory_order_relaxed);
    if (now < slice_end && !pool_.IsDueBefore(now, *this)) return false;
    cancelled_by = cancel;
    due = deadline;
    return pool_.Pause(*this);
  }

  // Sets whether others wait. The wish stays as long as a sign of life was asked for in vain.
  void Want(bool others_wait) {
    const bool is_asked = heard_of.load(std::memory_order_relaxed) < asked;
    if (wanted() != (others_wait || is_asked)) SetWanted(!wanted());
  }

  // Begins a slice of work.
  void BeginSlice(double worked) {
    slice_begin = Clock::now();
    slice_end = slice_begin + kSlice;
    slice_worked = worked;
    looked_at_clock = slice_begin;
    calls_to_clock = 1;
    heard_of.store(slice_begin, std::memory_order_relaxed);
  }

  std::thread thread;
  std::thread::id id;
  Task task;
  bool works = false;    // it has a permit
  bool resumes = false;  // got a permit after a pause
  ConditionVariable resumed;

  std::atomic<Clock::time_point> heard_of{};
  Clock::time_point asked{};  // when a sign of life was asked for

  // Used by the thread alone.
  Clock::time_point slice_begin;
  Clock::time_point slice_end;
  double slice_worked = 0;  // by the work clock, when the slice began
  Clock::time_point looked_at_clock;
  int calls_to_clock = 1;
  const CancelToken* cancelled_by = nullptr;
  std::optional<Clock::time_point> due;

 private:
  WorkerPool& pool_;
};

// The pool's mutex guards all members except the constants.
class WorkerPool::QueueImpl : public Queue,
                              public FairOrder::Member,
                              public std::enable_shared_from_this<QueueImpl> {
 public:
  QueueImpl(WorkerPool& pool, std::string caller, std::function<void()> on_no_memory)
      : pool(pool), caller(std::move(caller)), on_no_memory(std::move(on_no_memory)) {}

  void Submit(std::function<void()> task) override { SubmitLarge(std::move(task), 0, 0); }

  void SubmitLarge(std::function<void()> task, int64_t points, uint64_t rank) override {
    pool.Submit(shared_from_this(),
                {std::move(task), Clock::now(), points, rank, shared_from_this()});
  }

  int threads() const override { return pool.threads(); }

  Turn* turn() override { return pool.WorkerOfThisThread(); }

  QueueWait wait() const override {
    MutexLock lock(pool.mutex_);
    return waited;
  }

  double busy_seconds() const override {
    MutexLock lock(pool.mutex_);
    return busy;
  }

  bool idle() const override {
    MutexLock lock(pool.mutex_);
    return Idle();
  }

  void set_due(Clock::time_point at) override { pool.SetDue(*this, at); }

  void set_job(const std::string& name) override {
    MutexLock lock(pool.mutex_);
    job = name;
  }

  bool Idle() const { return tasks.empty() && under_way == 0; }
  bool HasSomethingToDo() const { return !tasks.empty() || !paused.empty(); }

  WorkerPool& pool;
  const std::string caller;
  std::string job;
  Caller* entry = nullptr;  // of the caller; null while the queue is idle
  const std::function<void()> on_no_memory;
  std::deque<Task> tasks;  // those of lower rank first
  std::deque<Worker*> paused;
  std::atomic<Clock::time_point> due = Clock::time_point::max();  // the pool's mutex guards changes
  int under_way = 0;                                              // tasks begun and not yet ended
  bool held_back = false;                                         // in held_back_
  double busy = 0;                                                // seconds
  QueueWait waited;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_WORKER_POOL_PARTS_H_
