#include "client/gcode/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace traverse::gcode {

void ParallelFor(size_t n, int threads, const std::function<void(size_t)>& body,
                 const WorkLimit& limit) {
  std::atomic<size_t> next{0};
  std::atomic<bool> failed{false};
  std::exception_ptr fault;  // the first
  const auto work = [&] {
    try {
      for (size_t i = next++; i < n && !limit.Ended(); i = next++) body(i);
    } catch (...) {
      next = n;
      if (!failed.exchange(true)) fault = std::current_exception();
    }
  };
  const size_t helpers = std::min(n, static_cast<size_t>(std::max(threads, 1)));
  {
    std::vector<std::jthread> pool;
    pool.reserve(helpers);
    try {
      while (pool.size() + 1 < helpers) pool.emplace_back(work);
    } catch (const std::system_error&) {
      // The process may have no more threads: those that there are do it all.
    }
    work();
  }
  if (fault != nullptr) std::rethrow_exception(fault);
}

int DefaultThreads() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

int ThreadsFor(size_t bytes) {
  constexpr size_t kShortBytes = size_t{32} << 10;
  return bytes < kShortBytes ? 1 : DefaultThreads();
}

}  // namespace traverse::gcode
