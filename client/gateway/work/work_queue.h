// Who is served when: a bounded number of requests, fair between callers, each with its memory.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_WORK_QUEUE_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_WORK_QUEUE_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/statusor.h"
#include "engine/base/mutex.h"

namespace traverse::gateway {

struct WorkLimits {
  int workers = 2;                              // requests that are worked on at a time
  int max_requests = 256;                       // from their heads on
  int max_requests_per_caller = 64;             // the same of one caller
  int64_t max_memory_bytes = int64_t{1} << 30;  // of those that are worked on
};

// Thread-safe.
class WorkQueue {
 public:
  // A request's place in the queue, from Enter until the ticket is destroyed.
  class Ticket {
   public:
    ~Ticket();
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

    const std::string& caller() const { return caller_; }

   private:
    friend class WorkQueue;
    Ticket(WorkQueue& queue, std::string caller) : queue_(queue), caller_(std::move(caller)) {}

    WorkQueue& queue_;
    const std::string caller_;
  };

  explicit WorkQueue(const WorkLimits& limits);

  // Waits for tasks that run; those that wait are dropped.
  ~WorkQueue();

  // A ticket for a request of `caller`. ResourceExhausted if the queue is full, whose last quarter
  // is for callers who have no place; Unavailable when draining. The queue outlives it.
  absl::StatusOr<std::shared_ptr<Ticket>> Enter(const std::string& caller);

  // Runs `task` as soon as a worker is free and `memory_bytes` are, callers taking turns.
  // REQUIRES: no more than max_memory_bytes().
  void Submit(std::shared_ptr<Ticket> ticket, int64_t memory_bytes, std::function<void()> task);

  // While memory is short, a task begins only if none is under way.
  void SetMemoryShort(bool is_short);

  // No more places from now on.
  void StartDraining();
  bool draining() const;

  int64_t max_memory_bytes() const { return limits_.max_memory_bytes; }
  int requests() const;          // places taken
  int waiting() const;           // tasks that wait
  int running() const;           // tasks under way
  int64_t memory_bytes() const;  // of tasks under way

 private:
  struct Task {
    std::shared_ptr<Ticket> ticket;
    int64_t memory_bytes;
    std::function<void()> run;
  };

  void Work();

  // The next task that may run now: of the caller whose turn it is. False if there is none.
  bool TakeNext(Task& task) TRAVERSE_REQUIRES(mutex_);

  const WorkLimits limits_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  std::map<std::string, int> places_ TRAVERSE_GUARDED_BY(mutex_);  // by caller
  int requests_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  std::map<std::string, std::deque<Task>> waiting_
      TRAVERSE_GUARDED_BY(mutex_);                       // by caller; none is empty
  std::string last_caller_ TRAVERSE_GUARDED_BY(mutex_);  // whose turn it was
  int waiting_count_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int running_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int64_t memory_bytes_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  bool memory_short_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool draining_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool stopping_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> workers_;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_WORK_QUEUE_H_
