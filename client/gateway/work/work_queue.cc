#include "client/gateway/work/work_queue.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"

namespace traverse::gateway {

WorkQueue::Ticket::~Ticket() {
  MutexLock lock(queue_.mutex_);
  --queue_.requests_;
  const auto of_caller = queue_.places_.find(caller_);
  if (--of_caller->second == 0) queue_.places_.erase(of_caller);
}

WorkQueue::WorkQueue(const WorkLimits& limits) : limits_(limits) {
  for (int i = 0; i < limits_.workers; ++i) workers_.emplace_back([this] { Work(); });
}

WorkQueue::~WorkQueue() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyAll();
  for (std::thread& worker : workers_) worker.join();
  // Destroyed after the lock is released: places lock the mutex in their destructors.
  std::map<std::string, std::deque<Task>> dropped;
  {
    MutexLock lock(mutex_);
    dropped = std::exchange(waiting_, {});
  }
}

absl::StatusOr<std::shared_ptr<WorkQueue::Ticket>> WorkQueue::Enter(const std::string& caller) {
  MutexLock lock(mutex_);
  if (draining_) return absl::UnavailableError("the gateway is shutting down; ask another one");
  if (requests_ >= limits_.max_requests) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("%d requests are under way; come again later", requests_));
  }
  const auto of_caller = places_.find(caller);
  if (of_caller != places_.end() && of_caller->second >= limits_.max_requests_per_caller) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("%d requests of this caller are under way", of_caller->second));
  }
  if (of_caller != places_.end() && requests_ >= limits_.max_requests - limits_.max_requests / 4) {
    return absl::ResourceExhaustedError(absl::StrFormat(
        "of %d places for requests the last %d are for callers who have none; come again later",
        limits_.max_requests, limits_.max_requests / 4));
  }
  ++requests_;
  ++places_[caller];
  return std::shared_ptr<Ticket>(new Ticket(*this, caller));
}

void WorkQueue::Submit(std::shared_ptr<Ticket> ticket, int64_t memory_bytes,
                       std::function<void()> task) {
  assert(memory_bytes <= limits_.max_memory_bytes);
  const std::string caller = ticket->caller();
  {
    MutexLock lock(mutex_);
    ++waiting_count_;
    waiting_[caller].push_back({std::move(ticket), memory_bytes, std::move(task)});
  }
  changed_.NotifyOne();
}

void WorkQueue::SetMemoryShort(bool is_short) {
  {
    MutexLock lock(mutex_);
    if (std::exchange(memory_short_, is_short) == is_short) return;
  }
  changed_.NotifyAll();
}

void WorkQueue::StartDraining() {
  MutexLock lock(mutex_);
  draining_ = true;
}

bool WorkQueue::draining() const {
  MutexLock lock(mutex_);
  return draining_;
}

int WorkQueue::requests() const {
  MutexLock lock(mutex_);
  return requests_;
}

int WorkQueue::waiting() const {
  MutexLock lock(mutex_);
  return waiting_count_;
}

int WorkQueue::running() const {
  MutexLock lock(mutex_);
  return running_;
}

int64_t WorkQueue::memory_bytes() const {
  MutexLock lock(mutex_);
  return memory_bytes_;
}

// Strictly takes turns, even if a small task would fit and the large one whose turn it is would
// not: otherwise the large one would never start.
bool WorkQueue::TakeNext(Task& task) {
  if (waiting_.empty() || (memory_short_ && running_ > 0)) return false;
  auto next = waiting_.upper_bound(last_caller_);
  if (next == waiting_.end()) next = waiting_.begin();
  const int64_t bytes = next->second.front().memory_bytes;
  if (memory_bytes_ + bytes > limits_.max_memory_bytes) return false;
  task = std::move(next->second.front());
  next->second.pop_front();
  last_caller_ = next->first;
  if (next->second.empty()) waiting_.erase(next);
  --waiting_count_;
  ++running_;
  memory_bytes_ += bytes;
  return true;
}

void WorkQueue::Work() {
  MutexLock lock(mutex_);
  while (true) {
    Task task;
    while (!stopping_ && !TakeNext(task)) changed_.Wait(mutex_);
    if (task.run == nullptr) return;
    lock.Unlock();
    task.run();
    const int64_t bytes = task.memory_bytes;
    task = {};
    lock.Lock();
    --running_;
    memory_bytes_ -= bytes;
    changed_.NotifyAll();
  }
}

}  // namespace traverse::gateway
