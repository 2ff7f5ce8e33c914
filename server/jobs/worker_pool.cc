#include "server/jobs/worker_pool.h"

#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

namespace traverse {
namespace {

// How often a paused task looks whether it was cancelled.
constexpr std::chrono::milliseconds kLooksForCancel{40};

}  // namespace

// A thread, and the turn of the task that it runs. Guarded by the pool's mutex, but for what the
// thread alone uses.
class WorkerPool::Worker : public Turn {
 public:
  explicit Worker(WorkerPool& pool) : pool_(pool) {}

  // Quick while its slice lasts.
  bool GiveWay(const CancelToken* cancel, std::optional<Clock::time_point> deadline) override {
    const Clock::time_point now = Clock::now();
    heard_of.store(now, std::memory_order_relaxed);
    if (now < slice_end) return false;
    cancelled_by = cancel;
    due = deadline;
    return pool_.Pause(*this);
  }

  // Whether others wait. The wish stays as long as a sign of life was asked for in vain.
  void Want(bool others_wait) {
    const bool is_asked = heard_of.load(std::memory_order_relaxed) < asked;
    if (wanted() != (others_wait || is_asked)) SetWanted(!wanted());
  }

  // Begins a slice of work.
  void BeginSlice(double worked) {
    slice_begin = Clock::now();
    slice_end = slice_begin + kSlice;
    slice_worked = worked;
    heard_of.store(slice_begin, std::memory_order_relaxed);
  }

  std::thread thread;
  std::thread::id id;
  Task task;
  bool works = false;    // it has a permit
  bool resumes = false;  // was given one after a pause
  ConditionVariable resumed;

  std::atomic<Clock::time_point> heard_of{};
  Clock::time_point asked{};  // when a sign of life was asked for

  // Used by the thread alone.
  Clock::time_point slice_begin;
  Clock::time_point slice_end;
  double slice_worked = 0;  // by the work clock, as the slice began
  const CancelToken* cancelled_by = nullptr;
  std::optional<Clock::time_point> due;

 private:
  WorkerPool& pool_;
};

// All members but the constants are guarded by the pool's mutex.
class WorkerPool::QueueImpl : public Queue,
                              public FairOrder::Member,
                              public std::enable_shared_from_this<QueueImpl> {
 public:
  QueueImpl(WorkerPool& pool, std::string caller, std::function<void()> on_no_memory)
      : pool(pool), caller(std::move(caller)), on_no_memory(std::move(on_no_memory)) {}

  void Submit(std::function<void()> task) override { SubmitLarge(std::move(task), 0); }

  void SubmitLarge(std::function<void()> task, int64_t points) override {
    pool.Submit(shared_from_this(), {std::move(task), Clock::now(), points, shared_from_this()});
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
  std::deque<Task> tasks;
  std::deque<Worker*> paused;
  int under_way = 0;       // tasks begun and not ended
  bool held_back = false;  // in held_back_
  double busy = 0;         // seconds
  QueueWait waited;
};

double WorkerPool::ThreadCpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

WorkerPool::WorkerPool(int permits, WorkClock clock, int nice)
    : clock_(std::move(clock)), permits_(std::max(1, permits)), nice_(nice) {
  MutexLock lock(mutex_);
  for (int i = 0; i < permits_; ++i) AddThread();
}

WorkerPool::~WorkerPool() {
  std::vector<std::unique_ptr<Worker>> workers;
  {
    MutexLock lock(mutex_);
    stopping_ = true;
    work_.NotifyAll();
    // Others may still be added by what is left to do.
    while (under_way_ > 0 || waiting_ > 0) work_.Wait(mutex_);
    workers = std::move(workers_);
    std::move(retired_.begin(), retired_.end(), std::back_inserter(workers));
    work_.NotifyAll();
  }
  for (const auto& worker : workers) worker->thread.join();
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

WorkerPool::Worker* WorkerPool::WorkerOfThisThread() const {
  MutexLock lock(mutex_);
  const std::thread::id id = std::this_thread::get_id();
  for (const auto& worker : workers_) {
    if (worker->id == id) return worker.get();
  }
  return nullptr;
}

void WorkerPool::Submit(const std::shared_ptr<QueueImpl>& queue, Task task) {
  MutexLock lock(mutex_);
  if (queue->Idle()) Enter(*queue);
  queue->tasks.push_back(std::move(task));
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
  if (!caller.waits()) turns_.Wait(caller);
}

void WorkerPool::WithdrawIfNothing(QueueImpl& queue) {
  if (queue.HasSomethingToDo() || !queue.waits()) return;
  Caller& caller = *queue.entry;
  caller.turns.Withdraw(queue);
  if (caller.turns.empty()) turns_.Withdraw(caller);
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

WorkerPool::QueueImpl* WorkerPool::TakeNext() {
  while (!turns_.empty()) {
    auto& caller = static_cast<Caller&>(turns_.TakeNext());
    auto& queue = static_cast<QueueImpl&>(caller.turns.TakeNext());
    if (!caller.turns.empty()) turns_.Wait(caller);
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
  // Whoever ends the pool waits as well.
  stopping_ ? work_.NotifyAll() : work_.NotifyOne();
  return true;
}

// Those at work give way only if others wait that could go on.
void WorkerPool::TellWorkers() {
  for (const auto& worker : workers_) {
    if (worker->works) worker->Want(!turns_.empty());
  }
}

// What the worker did since its slice began.
void WorkerPool::Charge(Worker& worker) {
  QueueImpl& queue = *worker.task.queue;
  const double worked = clock_() - worker.slice_worked;
  queue.busy += std::chrono::duration<double>(Clock::now() - worker.slice_begin).count();
  queue.entry->turns.Charge(queue, worked);
  turns_.Charge(*queue.entry, worked);
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

// For the turn, or until there is nothing left to do but to return what there is: that is quick,
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

void WorkerPool::ReleaseHeldBack() {
  while (!held_back_.empty()) {
    const std::shared_ptr<QueueImpl> other = std::move(held_back_.front());
    held_back_.pop_front();
    other->held_back = false;
    LetWait(*other);
  }
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
  if (stopping_ || idle_ <= static_cast<size_t>(2 * permits_) + handed_out_.size()) return false;
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
    worker.task.run = nullptr;  // frees what it holds
    if (worker.task.queue->on_no_memory) worker.task.queue->on_no_memory();
  }
  worker.task.run = nullptr;  // what it holds is freed before the thread counts as idle
}

void WorkerPool::RunTasks(Worker& worker) {
  // On Linux a thread has a nice value of its own.
  if (nice_ > 0) setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + nice_);
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
    Dispatch();
    if (stopping_) work_.NotifyAll();
    lock.Unlock();
    worker.task.queue = nullptr;  // may be the last to hold it
    lock.Lock();
  }
}

}  // namespace traverse
