#include "server/worker_pool.h"

#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <new>
#include <utility>

namespace traverse {

// All members but the constants are guarded by the pool's mutex.
class WorkerPool::QueueImpl : public Queue,
                              public FairOrder::Member,
                              public std::enable_shared_from_this<QueueImpl> {
 public:
  QueueImpl(WorkerPool& pool, std::string caller, std::function<void()> on_no_memory)
      : pool(pool), caller(std::move(caller)), on_no_memory(std::move(on_no_memory)) {}

  void Submit(std::function<void()> task) override {
    // The task may have run and have destroyed this queue by the time that a thread is notified.
    WorkerPool& owner = pool;
    {
      std::lock_guard<std::mutex> lock(owner.mutex_);
      owner.Submit(shared_from_this(), std::move(task));
    }
    owner.work_.notify_one();
  }

  int threads() const override { return pool.threads(); }

  QueueWait wait() const override {
    std::lock_guard<std::mutex> lock(pool.mutex_);
    return waited;
  }

  double busy_seconds() const override {
    std::lock_guard<std::mutex> lock(pool.mutex_);
    return busy;
  }

  bool idle() const override {
    std::lock_guard<std::mutex> lock(pool.mutex_);
    return Idle();
  }

  bool Idle() const { return tasks.empty() && running == 0; }

  WorkerPool& pool;
  const std::string caller;
  Caller* entry = nullptr;  // of the caller; null while the queue is idle
  const std::function<void()> on_no_memory;
  std::deque<Task> tasks;
  int running = 0;
  double busy = 0;  // seconds
  QueueWait waited;
};

double WorkerPool::ThreadCpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

WorkerPool::WorkerPool(int threads, WorkClock clock, int nice) : clock_(std::move(clock)) {
  for (int i = 0; i < std::max(1, threads); ++i) {
    threads_.emplace_back([this, nice] {
      // On Linux a thread has a nice value of its own.
      if (nice > 0) setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + nice);
      RunTasks();
    });
  }
}

WorkerPool::~WorkerPool() {
  {
    std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  work_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

std::shared_ptr<WorkerPool::Queue> WorkerPool::NewQueue(const std::string& caller,
                                                        std::function<void()> on_no_memory) {
  return std::make_shared<QueueImpl>(*this, caller, std::move(on_no_memory));
}

int WorkerPool::busy() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return busy_;
}

int64_t WorkerPool::waiting() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return waiting_;
}

void WorkerPool::Submit(const std::shared_ptr<QueueImpl>& queue, std::function<void()> run) {
  if (queue->Idle()) Enter(*queue);
  queue->tasks.push_back({std::move(run), Clock::now(), queue});
  ++waiting_;
  if (queue->tasks.size() > 1) return;
  Caller& caller = *queue->entry;
  if (caller.turns.empty()) turns_.Wait(caller);
  caller.turns.Wait(*queue);
}

void WorkerPool::Enter(QueueImpl& queue) {
  const auto [caller, is_new] = callers_.try_emplace(queue.caller);
  if (is_new) turns_.Enter(caller->second);
  ++caller->second.queues;
  queue.entry = &caller->second;
  caller->second.turns.Enter(queue);
}

void WorkerPool::LeaveIfIdle(QueueImpl& queue) {
  if (!queue.Idle()) return;
  Caller& caller = *std::exchange(queue.entry, nullptr);
  caller.turns.Leave(queue);
  if (--caller.queues > 0) return;
  turns_.Leave(caller);
  callers_.erase(queue.caller);
}

WorkerPool::Task WorkerPool::TakeNext() {
  auto& caller = static_cast<Caller&>(turns_.TakeNext());
  auto* const queue = static_cast<QueueImpl*>(&caller.turns.TakeNext());
  Task task = std::move(queue->tasks.front());
  queue->tasks.pop_front();
  --waiting_;
  if (!queue->tasks.empty()) caller.turns.Wait(*queue);
  if (!caller.turns.empty()) turns_.Wait(caller);
  const double waited = std::chrono::duration<double>(Clock::now() - task.submitted).count();
  if (queue->waited.tasks++ == 0) queue->waited.first_seconds = waited;
  queue->waited.longest_seconds = std::max(queue->waited.longest_seconds, waited);
  ++queue->running;
  return task;
}

void WorkerPool::EndTask(const Task& task, double wall_seconds, double work_seconds) {
  QueueImpl& queue = *task.queue;
  --queue.running;
  queue.busy += wall_seconds;
  queue.entry->turns.Charge(queue, work_seconds);
  turns_.Charge(*queue.entry, work_seconds);
  LeaveIfIdle(queue);
}

void WorkerPool::RunTasks() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    work_.wait(lock, [this] { return waiting_ > 0 || stopping_; });
    if (waiting_ == 0) return;
    Task task = TakeNext();
    ++busy_;
    lock.unlock();
    const Clock::time_point began = Clock::now();
    const double worked = clock_();
    try {
      task.run();
    } catch (const std::bad_alloc&) {
      task.run = nullptr;  // frees what it holds
      if (task.queue->on_no_memory) task.queue->on_no_memory();
    }
    task.run = nullptr;  // what it holds is freed before the thread counts as idle
    const double work_seconds = clock_() - worked;
    const double wall_seconds = std::chrono::duration<double>(Clock::now() - began).count();
    lock.lock();
    --busy_;
    EndTask(task, wall_seconds, work_seconds);
    lock.unlock();
    task.queue = nullptr;  // may be the last to hold it
    lock.lock();
  }
}

}  // namespace traverse
