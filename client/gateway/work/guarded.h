// Work on a caller's file, for which the memory of the process may not be enough.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_GUARDED_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_GUARDED_H_

#include <new>

#include "absl/status/status.h"

namespace traverse::gateway {

// What `work` returns; ResourceExhausted where the memory of the process was not enough for it.
template <typename Work>
auto Guarded(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("there is not enough memory for this file now");
  }
}

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_GUARDED_H_
