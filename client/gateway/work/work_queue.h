// Who is served when: a bounded number of requests, fair between callers, each with its memory.
//
// Callers take turns by how long workers have worked for them. Of places, workers and memory the
// last ones are for callers who have nothing there: whoever sends much, or large files, does not
// keep a small file of somebody else waiting.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_WORK_QUEUE_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_WORK_QUEUE_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/gcode/work_limit.h"
#include "engine/base/budget.h"
#include "engine/base/mutex.h"
#include "server/jobs/fair_order.h"

namespace traverse::gateway {

struct WorkLimits {
  // Requests that are worked on at a time. One more may be of a caller of whom none is, and sixteen
  // small ones, each of such a caller: a few whose work is endless keep nobody waiting.
  int workers = 2;
  int max_requests = 256;                             // from their heads on
  int max_requests_per_caller = 64;                   // the same of one caller
  int64_t max_memory_bytes = int64_t{1} << 30;        // of those that are worked on
  std::map<std::string, double> caller_weights = {};  // shares of the workers' time; others have 1
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

  // `time` (null: the steady clock) outlives it.
  explicit WorkQueue(const WorkLimits& limits, const TimeSource* time = nullptr);

  // Waits for tasks that run; those that wait are dropped.
  ~WorkQueue();

  // A ticket for a request of `caller`. ResourceExhausted if the queue is full, whose last quarter
  // is for callers who have no place; Unavailable when draining. The queue outlives it.
  absl::StatusOr<std::shared_ptr<Ticket>> Enter(const std::string& caller);

  // Runs `task` as soon as a worker is free and `memory_bytes` are, callers taking turns. A large
  // task whose turn it is waits for its memory, and others behind it; but not small ones of callers
  // of whom nothing is under way; and one whose `limit` has ended, and which will see that, waits
  // for nothing. REQUIRES: no more than max_memory_bytes().
  void Submit(std::shared_ptr<Ticket> ticket, int64_t memory_bytes, std::function<void()> task,
              const gcode::WorkLimit& limit = {});

  // While memory is short, a task begins only if none is under way, or as one of those small ones.
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
    gcode::WorkLimit limit;
    bool passes = false;  // others whose turn it is
  };

  // One with tasks that wait or are under way.
  struct Caller : FairOrder::Member {
    std::deque<Task> waiting;
    int running = 0;
    double weight = 1;
  };

  void Work();

  // The next task that may run now, and whose it is; null if there is none.
  Caller* TakeNext(Task& task) TRAVERSE_REQUIRES(mutex_);
  Caller* TakeEnded(Task& task) TRAVERSE_REQUIRES(mutex_);  // the same, of those past their limit

  // The task of `caller` at `waiting`, which from now on is under way.
  Task Take(Caller& caller, std::deque<Task>::iterator waiting) TRAVERSE_REQUIRES(mutex_);
  bool MayBegin(const Caller& caller, int64_t& waits_for) const TRAVERSE_REQUIRES(mutex_);
  void Done(const std::string& name, Caller& caller, double seconds) TRAVERSE_REQUIRES(mutex_);

  const WorkLimits limits_;
  const TimeSource* const time_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  std::map<std::string, int> places_ TRAVERSE_GUARDED_BY(mutex_);  // by caller
  int requests_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  std::map<std::string, Caller> callers_ TRAVERSE_GUARDED_BY(mutex_);
  FairOrder order_ TRAVERSE_GUARDED_BY(mutex_);  // of callers with tasks that wait
  int waiting_count_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int running_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  bool passing_ TRAVERSE_GUARDED_BY(mutex_) = false;  // a task that passed others is under way
  int64_t memory_bytes_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  Budget::Clock::time_point looked_ TRAVERSE_GUARDED_BY(mutex_);  // for ended tasks
  bool memory_short_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool draining_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool stopping_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> workers_;
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_WORK_QUEUE_H_
