#include "client/gateway/work/work_queue.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <iterator>
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

namespace {

// A small task takes no more than this part of the memory. So many of them may begin where all
// workers have tasks that end late or never.
constexpr int kSmallPart = 16;

// How often to look for tasks past their limits.
constexpr auto kLookEvery = std::chrono::milliseconds(250);

}  // namespace

WorkQueue::WorkQueue(const WorkLimits& limits, const TimeSource* time)
    : limits_(limits), time_(time) {
  for (int i = 0; i <= limits_.workers + kSmallPart; ++i) workers_.emplace_back([this] { Work(); });
}

WorkQueue::~WorkQueue() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyAll();
  for (std::thread& worker : workers_) worker.join();
  // Destroyed after the lock is released: places lock the mutex in their destructors.
  std::deque<Task> dropped;
  MutexLock lock(mutex_);
  for (auto& [name, caller] : callers_) {
    std::move(caller.waiting.begin(), caller.waiting.end(), std::back_inserter(dropped));
  }
  callers_.clear();
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
                       std::function<void()> task, const gcode::WorkLimit& limit) {
  assert(memory_bytes <= limits_.max_memory_bytes);
  const std::string name = ticket->caller();
  {
    MutexLock lock(mutex_);
    ++waiting_count_;
    const auto [found, is_new] = callers_.try_emplace(name);
    Caller& caller = found->second;
    if (is_new) {
      const auto weight = limits_.caller_weights.find(name);
      if (weight != limits_.caller_weights.end()) caller.weight = weight->second;
      order_.Enter(caller);
    }
    caller.waiting.push_back({std::move(ticket), memory_bytes, std::move(task), limit});
    if (!caller.waits()) order_.Wait(caller);
  }
  changed_.NotifyAll();
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

// Whether the first task of `caller` may begin. `waits_for`: what those whose turn it is need and
// wait for; then one small task at a time may pass for which there is room even beside that.
bool WorkQueue::MayBegin(const Caller& caller, int64_t& waits_for) const {
  const int64_t bytes = caller.waiting.front().memory_bytes;
  const int64_t most = limits_.max_memory_bytes;
  const bool fits = memory_bytes_ + bytes <= most;
  const bool small = bytes <= most / kSmallPart;
  if (waits_for > 0 || (memory_short_ && running_ > 0)) {
    return fits && caller.running == 0 && !passing_ && small && waits_for + bytes <= most;
  }
  if (running_ >= limits_.workers && caller.running > 0) return false;
  if (running_ > limits_.workers && !small) return false;
  if (!fits) waits_for = bytes;
  return fits;
}

WorkQueue::Task WorkQueue::Take(Caller& caller, std::deque<Task>::iterator waiting) {
  Task task = std::move(*waiting);
  caller.waiting.erase(waiting);
  ++caller.running;
  --waiting_count_;
  ++running_;
  return task;
}

WorkQueue::Caller* WorkQueue::TakeEnded(Task& task) {
  const Budget::Clock::time_point now = Budget::Clock::now();
  if (now - looked_ < kLookEvery) return nullptr;
  for (auto& [name, caller] : callers_) {
    const auto ended = std::ranges::find_if(
        caller.waiting, [](const Task& waiting) { return waiting.limit.Ended(); });
    if (ended == caller.waiting.end()) continue;
    task = Take(caller, ended);
    task.memory_bytes = 0;
    if (caller.waiting.empty()) order_.Withdraw(caller);
    return &caller;
  }
  looked_ = now;
  return nullptr;
}

WorkQueue::Caller* WorkQueue::TakeNext(Task& task) {
  if (Caller* const caller = TakeEnded(task); caller != nullptr) return caller;
  int64_t waits_for = 0;
  FairOrder::Member* const next = order_.TakeFirst([&](FairOrder::Member& member) {
    mutex_.AssertHeld();
    return MayBegin(static_cast<Caller&>(member), waits_for);
  });
  if (next == nullptr) return nullptr;
  Caller& caller = static_cast<Caller&>(*next);
  task = Take(caller, caller.waiting.begin());
  if (!caller.waiting.empty()) order_.Wait(caller);
  memory_bytes_ += task.memory_bytes;
  task.passes = waits_for > 0 || (memory_short_ && running_ > 1);
  passing_ = passing_ || task.passes;
  return &caller;
}

void WorkQueue::Done(const std::string& name, Caller& caller, double seconds) {
  order_.Charge(caller, seconds / caller.weight);
  --caller.running;
  if (caller.running > 0 || !caller.waiting.empty()) return;
  order_.Leave(caller);
  callers_.erase(name);
}

void WorkQueue::Work() {
  MutexLock lock(mutex_);
  while (true) {
    Task task;
    Caller* caller = nullptr;
    while (!stopping_ && (caller = TakeNext(task)) == nullptr) {
      if (waiting_count_ == 0) {
        changed_.Wait(mutex_);
      } else {
        changed_.WaitUntil(mutex_, Budget::Clock::now() + kLookEvery);
      }
    }
    if (caller == nullptr) return;
    lock.Unlock();
    const Budget::Clock::time_point began = Budget::Now(time_);
    const std::string name = task.ticket->caller();
    task.run();
    const double seconds = std::chrono::duration<double>(Budget::Now(time_) - began).count();
    const int64_t bytes = task.memory_bytes;
    const bool passed = task.passes;
    task = {};
    lock.Lock();
    if (passed) passing_ = false;
    --running_;
    memory_bytes_ -= bytes;
    Done(name, *caller, seconds);
    changed_.NotifyAll();
  }
}

}  // namespace traverse::gateway
