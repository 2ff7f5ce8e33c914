// Keeps a process that listens within its memory, whatever others send it.

#ifndef TRAVERSE_SERVER_NET_MEMORY_WATCH_H_
#define TRAVERSE_SERVER_NET_MEMORY_WATCH_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>

#include "server/net/connections.h"
#include "server/ops/periodic.h"

namespace traverse {

// Looks a hundred times a second, in a thread of its own. While the process uses much of its
// memory, returns what the allocator keeps, then says that memory is short, then cuts connections.
class MemoryWatch {
 public:
  struct Hooks {
    // Memory is short, or no longer: begin nothing that takes much. Called at each look.
    std::function<void(bool)> set_short;

    // The connection with the longest unfinished messages was cut.
    std::function<void()> on_cut;
  };

  // `max_memory`: what the process may use, in bytes. `connections` may be null, and must outlive
  // it.
  MemoryWatch(int64_t max_memory, Connections* connections, Hooks hooks);

 private:
  void Look();
  double Share() const;  // of its memory that the process uses; 1 is all

  // Returns what the allocator keeps to the system if the process uses `share` of its memory and
  // that is much. Returns whether it did so.
  bool GiveGarbageBack(double share);

  const int64_t max_memory_;
  Connections* const connections_;
  const Hooks hooks_;
  std::chrono::steady_clock::time_point trimmed_{};
  Periodic watch_;  // last: uses the other members
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_MEMORY_WATCH_H_
