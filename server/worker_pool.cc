#include "server/worker_pool.h"

#include <algorithm>
#include <new>
#include <utility>

namespace traverse {

// All members but the constants are guarded by the pool's mutex.
class WorkerPool::QueueImpl : public Queue, public std::enable_shared_from_this<QueueImpl> {
 public:
  QueueImpl(WorkerPool& pool, std::string caller, std::function<void()> on_no_memory)
      : pool(pool), caller(std::move(caller)), on_no_memory(std::move(on_no_memory)) {}

  void Submit(std::function<void()> task) override {
    pool.Submit(shared_from_this(), std::move(task));
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
    return tasks.empty() && running == 0;
  }

  WorkerPool& pool;
  const std::string caller;
  const std::function<void()> on_no_memory;
  std::deque<Task> tasks;
  int running = 0;
  double busy = 0;  // seconds
  QueueWait waited;
};

WorkerPool::WorkerPool(int threads) {
  for (int i = 0; i < std::max(1, threads); ++i) {
    threads_.emplace_back([this] { RunTasks(); });
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
  {
    std::lock_guard<std::mutex> lock(mutex_);
    queue->tasks.push_back({std::move(run), Clock::now()});
    ++waiting_;
    if (queue->tasks.size() == 1) {
      auto caller = caller_by_name_.find(queue->caller);
      if (caller == caller_by_name_.end()) {
        callers_.push_back({queue->caller, {}});
        caller = caller_by_name_.emplace(queue->caller, std::prev(callers_.end())).first;
      }
      caller->second->turns.push_back(queue);
    }
  }
  work_.notify_one();
}

WorkerPool::Task WorkerPool::TakeNext() {
  const auto caller = callers_.begin();
  const std::shared_ptr<QueueImpl> queue = std::move(caller->turns.front());
  caller->turns.pop_front();
  Task task = std::move(queue->tasks.front());
  queue->tasks.pop_front();
  --waiting_;
  if (!queue->tasks.empty()) caller->turns.push_back(queue);
  if (caller->turns.empty()) {
    caller_by_name_.erase(caller->name);
    callers_.erase(caller);
  } else {
    callers_.splice(callers_.end(), callers_, caller);
  }
  const double waited = std::chrono::duration<double>(Clock::now() - task.submitted).count();
  if (queue->waited.tasks++ == 0) queue->waited.first_seconds = waited;
  queue->waited.longest_seconds = std::max(queue->waited.longest_seconds, waited);
  ++queue->running;
  task.queue = queue;
  return task;
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
    try {
      task.run();
    } catch (const std::bad_alloc&) {
      task.run = nullptr;  // frees what it holds
      if (task.queue->on_no_memory) task.queue->on_no_memory();
    }
    task.run = nullptr;  // what it holds is freed before the thread counts as idle
    const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
    lock.lock();
    --busy_;
    --task.queue->running;
    task.queue->busy += seconds;
    lock.unlock();
    task.queue = nullptr;  // may be the last to hold it
    lock.lock();
  }
}

}  // namespace traverse
