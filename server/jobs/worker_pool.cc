#include "server/jobs/worker_pool.h"

#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "server/jobs/worker_pool_parts.h"

namespace traverse {

double WorkerPool::ThreadCpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

WorkerPool::WorkerPool(int permits, WorkClock clock, int nice)
    : clock_(std::move(clock)),
      permits_(std::max(1, permits)),
      nice_(getpriority(PRIO_PROCESS, 0) + nice) {
  MutexLock lock(mutex_);
  for (int i = 0; i < permits_; ++i) AddThread();
}

WorkerPool::~WorkerPool() {
  std::vector<std::unique_ptr<Worker>> workers;
  {
    MutexLock lock(mutex_);
    stopping_ = true;
    work_.NotifyAll();
    // The remaining tasks may still add others.
    while (under_way_ > 0 || waiting_ > 0) work_.Wait(mutex_);
    workers = std::move(workers_);
    std::move(retired_.begin(), retired_.end(), std::back_inserter(workers));
    work_.NotifyAll();
  }
  for (const auto& worker : workers) worker->thread.join();
  MutexLock lock(mutex_);
  assert(under_way_ == 0 && waiting_ == 0);
}

std::shared_ptr<WorkerPool::Queue> WorkerPool::NewQueue(const std::string& caller,
                                                        std::function<void()> on_no_memory) {
  return std::make_shared<QueueImpl>(*this, caller, std::move(on_no_memory));
}

int WorkerPool::busy() const {
  MutexLock lock(mutex_);
  return busy_;
}

size_t WorkerPool::thread_count() const {
  MutexLock lock(mutex_);
  return workers_.size();
}

int64_t WorkerPool::waiting() const {
  MutexLock lock(mutex_);
  return waiting_;
}

std::vector<SilentTask> WorkerPool::Silent(std::chrono::nanoseconds limit) {
  MutexLock lock(mutex_);
  const Clock::time_point now = Clock::now();
  std::vector<SilentTask> silent;
  for (const auto& worker : workers_) {
    if (!worker->works) continue;
    worker->asked = now;
    worker->Want(!turns_.empty());
    const auto since = now - worker->heard_of.load(std::memory_order_relaxed);
    if (since <= limit) continue;
    const QueueImpl& queue = *worker->task.queue;
    silent.push_back({queue.caller, queue.job, std::chrono::duration<double>(since).count()});
  }
  return silent;
}

void WorkerPool::Submit(const std::shared_ptr<QueueImpl>& queue, Task task) {
  MutexLock lock(mutex_);
  if (queue->Idle()) Enter(*queue);
  const auto before = [](const Task& a, const Task& b) { return a.rank < b.rank; };
  queue->tasks.insert(std::upper_bound(queue->tasks.begin(), queue->tasks.end(), task, before),
                      std::move(task));
  ++waiting_;
  LetWait(*queue);
  Dispatch();
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

void WorkerPool::LetWait(QueueImpl& queue) {
  if (!queue.HasSomethingToDo() || queue.waits() || queue.held_back) return;
  Caller& caller = *queue.entry;
  caller.turns.Wait(queue);
  AddToDue(queue);
  if (!caller.waits()) turns_.Wait(caller);
}

void WorkerPool::WithdrawIfNothing(QueueImpl& queue) {
  if (!queue.HasSomethingToDo() && queue.waits()) Withdraw(queue);
}

void WorkerPool::Withdraw(QueueImpl& queue) {
  Caller& caller = *queue.entry;
  caller.turns.Withdraw(queue);
  TakeFromDue(queue);
  if (caller.turns.empty() && caller.waits()) turns_.Withdraw(caller);
}

void WorkerPool::SetDue(QueueImpl& queue, Clock::time_point due) {
  MutexLock lock(mutex_);
  if (queue.waits()) TakeFromDue(queue);
  queue.due = due;
  if (queue.waits()) AddToDue(queue);
}

void WorkerPool::AddToDue(QueueImpl& queue) {
  if (queue.due.load() == Clock::time_point::max()) return;
  queue.entry->by_due.emplace(queue.due, &queue);
  by_due_.emplace(queue.due, &queue);
  next_due_.store(by_due_.begin()->first, std::memory_order_relaxed);
}

void WorkerPool::TakeFromDue(QueueImpl& queue) {
  if (queue.entry->by_due.erase({queue.due, &queue}) == 0) return;
  by_due_.erase({queue.due, &queue});
  next_due_.store(by_due_.empty() ? Clock::time_point::max() : by_due_.begin()->first,
                  std::memory_order_relaxed);
}

bool WorkerPool::IsDueBefore(Clock::time_point now, const Worker& worker) const {
  const Clock::time_point next = next_due_.load(std::memory_order_relaxed);
  return next <= now && next < worker.task.queue->due.load(std::memory_order_relaxed);
}

bool WorkerPool::MayBegin(const Task& task) const {
  if (under_way_ < static_cast<size_t>(permits_)) return true;
  if (under_way_ >= kMostUnderWay) return false;
  if (task.small()) return true;
  return !memory_short_ &&
         (task.large() ? large_points_ : middle_points_) + task.points <= most_points_;
}

int64_t* WorkerPool::PointsUnderWay(const Task& task) {
  if (task.small()) return nullptr;
  return task.large() ? &large_points_ : &middle_points_;
}

void WorkerPool::LimitMemory(int64_t bytes) {
  MutexLock lock(mutex_);
  most_points_ = std::min(kMostPoints, bytes / 2 / kBytesOfPoint);
}

void WorkerPool::SetMemoryShort(bool is_short) {
  MutexLock lock(mutex_);
  if (memory_short_ && !is_short) {
    memory_short_ = false;
    ReleaseHeldBack();
    Dispatch();
  }
  memory_short_ = is_short;
}

// A due one, or else the one that has had the least.
WorkerPool::QueueImpl& WorkerPool::TakeFirst() {
  const Clock::time_point now = Clock::now();
  const auto has_due = [now](const FairOrder::Member& member) {
    const ByDue& by_due = static_cast<const Caller&>(member).by_due;
    return !by_due.empty() && by_due.begin()->first <= now;
  };
  const bool is_due = next_due_.load(std::memory_order_relaxed) <= now;
  auto& caller = static_cast<Caller&>(is_due ? *turns_.TakeFirst(has_due) : turns_.TakeNext());
  QueueImpl* queue = is_due ? caller.by_due.begin()->second : nullptr;
  if (queue != nullptr) {
    caller.turns.Withdraw(*queue);
  } else {
    queue = static_cast<QueueImpl*>(&caller.turns.TakeNext());
  }
  TakeFromDue(*queue);
  if (!caller.turns.empty()) turns_.Wait(caller);
  return *queue;
}

WorkerPool::QueueImpl* WorkerPool::TakeNext() {
  while (!turns_.empty()) {
    QueueImpl& queue = TakeFirst();
    if (!queue.paused.empty() || MayBegin(queue.tasks.front())) return &queue;
    queue.held_back = true;
    held_back_.push_back(queue.shared_from_this());
  }
  return nullptr;
}

void WorkerPool::Dispatch() {
  while (busy_ < permits_) {
    QueueImpl* const queue = TakeNext();
    if (queue == nullptr) break;
    if (!queue->paused.empty()) {
      Worker* const worker = queue->paused.front();
      queue->paused.pop_front();
      worker->resumes = true;
      worker->works = true;
      --waiting_;
      ++busy_;
      worker->resumed.NotifyOne();
    } else if (!Begin(*queue)) {
      queue->held_back = true;
      held_back_.push_back(queue->shared_from_this());
      continue;
    }
    LetWait(*queue);
  }
  TellWorkers();
}

// Hands a task to a thread. False if there is none.
bool WorkerPool::Begin(QueueImpl& queue) {
  if (idle_ <= handed_out_.size() && !AddThread()) return false;
  Task task = std::move(queue.tasks.front());
  queue.tasks.pop_front();
  const double waited = std::chrono::duration<double>(Clock::now() - task.submitted).count();
  if (queue.waited.tasks++ == 0) queue.waited.first_seconds = waited;
  queue.waited.longest_seconds = std::max(queue.waited.longest_seconds, waited);
  ++queue.under_way;
  ++under_way_;
  if (int64_t* const points = PointsUnderWay(task)) *points += task.points;
  --waiting_;
  ++busy_;
  handed_out_.push_back(std::move(task));
  // Wakes nobody for a task that an awake thread will take. Whoever ends the pool waits as well.
  if (stopping_) {
    work_.NotifyAll();
  } else if (handed_out_.size() > looking_) {
    work_.NotifyOne();
  }
  return true;
}

// Working tasks yield only if others wait that could continue.
void WorkerPool::TellWorkers() {
  for (const auto& worker : workers_) {
    if (worker->works) worker->Want(!turns_.empty());
  }
}

void WorkerPool::ReleaseHeldBack() {
  while (!held_back_.empty()) {
    const std::shared_ptr<QueueImpl> other = std::move(held_back_.front());
    held_back_.pop_front();
    other->held_back = false;
    LetWait(*other);
  }
}

}  // namespace traverse
