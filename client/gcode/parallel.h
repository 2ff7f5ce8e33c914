// A loop with independent rounds, on several threads.

#ifndef TRAVERSE_CLIENT_GCODE_PARALLEL_H_
#define TRAVERSE_CLIENT_GCODE_PARALLEL_H_

#include <cstddef>
#include <functional>

#include "client/gcode/work_limit.h"

namespace traverse::gcode {

// Calls body(0) to body(n - 1) on at most `threads` threads, fewer where the system gives no more,
// unless `limit` ends first. Returns
// when all have returned. What one of them throws, because there is no memory, reaches the caller.
void ParallelFor(size_t n, int threads, const std::function<void(size_t)>& body,
                 const WorkLimit& limit = {});

// As many threads as the machine has processors.
int DefaultThreads();

// The same for work on a text of `bytes` bytes; one for a text so short that it is done before
// another thread has begun.
int ThreadsFor(size_t bytes);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PARALLEL_H_
