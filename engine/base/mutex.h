// A mutex whose use the compiler checks: clang's -Wthread-safety reports every member that
// is read or written without the lock that guards it.
//
//   Mutex mutex_;
//   int jobs_ TRAVERSE_GUARDED_BY(mutex_) = 0;
//
//   void Count() TRAVERSE_EXCLUDES(mutex_) {
//     MutexLock lock(mutex_);
//     ++jobs_;
//   }
//
// A thin wrapper of std::mutex. Debian's absl::Mutex is not instrumented, so
// ThreadSanitizer would report what it guards as unguarded. Other compilers ignore the
// annotations.

#ifndef TRAVERSE_ENGINE_BASE_MUTEX_H_
#define TRAVERSE_ENGINE_BASE_MUTEX_H_

#include <chrono>
#include <condition_variable>
#include <mutex>

#if defined(__clang__)
#define TRAVERSE_THREAD_ANNOTATION(x) __attribute__((x))
#else
#define TRAVERSE_THREAD_ANNOTATION(x)
#endif

// For a member: reading and writing it requires the mutex.
#define TRAVERSE_GUARDED_BY(mutex) TRAVERSE_THREAD_ANNOTATION(guarded_by(mutex))
// For a function: the caller holds the mutex, before and after.
#define TRAVERSE_REQUIRES(...) TRAVERSE_THREAD_ANNOTATION(requires_capability(__VA_ARGS__))
// For a function: the caller does not hold the mutex; the function takes it.
#define TRAVERSE_EXCLUDES(...) TRAVERSE_THREAD_ANNOTATION(locks_excluded(__VA_ARGS__))
// For a function that the analysis cannot follow. Say why where you use it.
#define TRAVERSE_NO_THREAD_SAFETY_ANALYSIS TRAVERSE_THREAD_ANNOTATION(no_thread_safety_analysis)

namespace traverse {

class TRAVERSE_THREAD_ANNOTATION(capability("mutex")) Mutex {
 public:
  Mutex() = default;
  Mutex(const Mutex&) = delete;
  Mutex& operator=(const Mutex&) = delete;

  void Lock() TRAVERSE_THREAD_ANNOTATION(acquire_capability()) { mutex_.lock(); }
  void Unlock() TRAVERSE_THREAD_ANNOTATION(release_capability()) { mutex_.unlock(); }

  // Tells the analysis what it cannot see: this mutex is held here, under another name or around a
  // lambda. Does nothing at run time.
  void AssertHeld() const TRAVERSE_THREAD_ANNOTATION(assert_capability(this)) {}

 private:
  friend class ConditionVariable;
  std::mutex mutex_;
};

// Holds a mutex from construction to destruction, except between Unlock and Lock.
class TRAVERSE_THREAD_ANNOTATION(scoped_lockable) MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) TRAVERSE_THREAD_ANNOTATION(acquire_capability(mutex))
      : mutex_(mutex) {
    mutex_.Lock();
  }
  ~MutexLock() TRAVERSE_THREAD_ANNOTATION(release_capability()) {
    if (held_) mutex_.Unlock();
  }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  void Unlock() TRAVERSE_THREAD_ANNOTATION(release_capability()) {
    held_ = false;
    mutex_.Unlock();
  }
  void Lock() TRAVERSE_THREAD_ANNOTATION(acquire_capability()) {
    mutex_.Lock();
    held_ = true;
  }

 private:
  Mutex& mutex_;
  bool held_ = true;
};

// The caller writes the waiting loop, so that the analysis sees what the condition reads:
//
//   MutexLock lock(mutex_);
//   while (!ready_) changed_.Wait(mutex_);
class ConditionVariable {
 public:
  void NotifyOne() { condition_.notify_one(); }
  void NotifyAll() { condition_.notify_all(); }

  // Releases the mutex until a notification, or a spurious wake-up, and takes it again.
  void Wait(Mutex& mutex) TRAVERSE_REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    condition_.wait(lock);
    lock.release();
  }

  // Like Wait, but until `time` at the latest. Returns false if that time has come.
  template <typename Clock, typename Duration>
  bool WaitUntil(Mutex& mutex, const std::chrono::time_point<Clock, Duration>& time)
      TRAVERSE_REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    const std::cv_status status = condition_.wait_until(lock, time);
    lock.release();
    return status == std::cv_status::no_timeout;
  }

 private:
  std::condition_variable condition_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_MUTEX_H_
