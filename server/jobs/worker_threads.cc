// The threads of a WorkerPool: their turns, pauses and ends.

#include <sys/resource.h>

#include <algorithm>
#include <new>
#include <system_error>
#include <utility>

#include "server/jobs/worker_pool_parts.h"

namespace traverse {
namespace {

// How often a paused task looks whether it was cancelled.
constexpr std::chrono::milliseconds kLooksForCancel{40};

}  // namespace

WorkerPool::Worker* WorkerPool::WorkerOfThisThread() const {
  MutexLock lock(mutex_);
  const std::thread::id id = std::this_thread::get_id();
  for (const auto& worker : workers_) {
    if (worker->id == id) return worker.get();
  }
  return nullptr;
}

double WorkerPool::WeightOf(const std::string& caller) const {
  const auto weight = weights_.find(caller);
  return weight == weights_.end() ? 1 : weight->second;
}

// What the worker did since its slice began.
void WorkerPool::Charge(Worker& worker) {
  QueueImpl& queue = *worker.task.queue;
  const double worked = clock_() - worker.slice_worked;
  queue.busy += std::chrono::duration<double>(Clock::now() - worker.slice_begin).count();
  queue.entry->turns.Charge(queue, worked);
  turns_.Charge(*queue.entry, worked / WeightOf(queue.caller));
}

bool WorkerPool::Pause(Worker& worker) {
  MutexLock lock(mutex_);
  Charge(worker);
  if (turns_.empty()) {
    worker.BeginSlice(clock_());
    worker.Want(false);
    return false;
  }
  QueueImpl& queue = *worker.task.queue;
  queue.paused.push_back(&worker);
  worker.works = false;
  worker.resumes = false;
  ++waiting_;
  --busy_;
  if (queue.held_back) {
    queue.held_back = false;
    held_back_.erase(std::find(held_back_.begin(), held_back_.end(), worker.task.queue));
  }
  LetWait(queue);
  Dispatch();
  const bool waits = !worker.resumes;
  WaitForTurn(worker);
  worker.BeginSlice(clock_());
  worker.Want(!turns_.empty());
  return waits;
}

// Waits for its turn, or until nothing is left to do but to return what there is: that is quick,
// and done beyond the permits.
void WorkerPool::WaitForTurn(Worker& worker) {
  while (!worker.resumes) {
    const Clock::time_point now = Clock::now();
    const bool is_late = worker.due && now >= *worker.due;
    if (is_late || (worker.cancelled_by != nullptr && worker.cancelled_by->cancelled())) {
      QueueImpl& queue = *worker.task.queue;
      queue.paused.erase(std::find(queue.paused.begin(), queue.paused.end(), &worker));
      WithdrawIfNothing(queue);
      worker.works = true;
      --waiting_;
      ++busy_;
      return;
    }
    Clock::time_point until = now + kLooksForCancel;
    if (worker.due) until = std::min(until, *worker.due);
    worker.resumed.WaitUntil(mutex_, until);
  }
}

void WorkerPool::EndTask(Worker& worker) {
  Charge(worker);
  const std::shared_ptr<QueueImpl> queue = worker.task.queue;
  if (int64_t* const points = PointsUnderWay(worker.task)) *points -= worker.task.points;
  worker.works = false;
  --busy_;
  --queue->under_way;
  --under_way_;
  LeaveIfIdle(*queue);
  ReleaseHeldBack();
}

bool WorkerPool::AddThread() {
  for (const auto& worker : retired_) worker->thread.join();
  retired_.clear();
  auto worker = std::make_unique<Worker>(*this);
  try {
    worker->thread = std::thread([this, added = worker.get()] { RunTasks(*added); });
  } catch (const std::system_error&) {
    return false;
  }
  worker->id = worker->thread.get_id();
  workers_.push_back(std::move(worker));
  ++idle_;
  return true;
}

// Threads that many paused tasks had needed are not kept.
bool WorkerPool::RetireIfTooMany(Worker& worker) {
  if (stopping_ || !handed_out_.empty() || idle_ <= static_cast<size_t>(2 * permits_)) return false;
  --idle_;
  const auto own = std::find_if(workers_.begin(), workers_.end(),
                                [&](const auto& other) { return other.get() == &worker; });
  retired_.push_back(std::move(*own));
  workers_.erase(own);
  return true;
}

void WorkerPool::Run(Worker& worker) {
  worker.BeginSlice(clock_());
  try {
    worker.task.run();
  } catch (const std::bad_alloc&) {
    worker.task.run = nullptr;  // frees what the task holds
    if (worker.task.queue->on_no_memory) worker.task.queue->on_no_memory();
  }
  worker.task.run = nullptr;  // frees what the task holds before the thread counts as idle
}

void WorkerPool::RunTasks(Worker& worker) {
  // On Linux a thread has a nice value of its own, and begins with that of the thread that made it,
  // which may be a worker.
  setpriority(PRIO_PROCESS, 0, nice_);
  MutexLock lock(mutex_);
  while (!RetireIfTooMany(worker)) {
    while (handed_out_.empty()) {
      if (stopping_ && under_way_ == 0 && waiting_ == 0) return;
      work_.Wait(mutex_);
    }
    worker.task = std::move(handed_out_.front());
    handed_out_.pop_front();
    --idle_;
    worker.works = true;
    worker.heard_of = Clock::now();
    worker.Want(!turns_.empty());
    lock.Unlock();
    Run(worker);
    lock.Lock();
    EndTask(worker);
    ++idle_;
    ++looking_;
    Dispatch();
    if (stopping_) work_.NotifyAll();
    lock.Unlock();
    worker.task.queue = nullptr;  // may be the last to hold it
    lock.Lock();
    --looking_;
  }
}

}  // namespace traverse
