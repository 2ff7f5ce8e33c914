// How much memory there is, and how much of it the process uses.

#ifndef TRAVERSE_SERVER_OPS_MEMORY_H_
#define TRAVERSE_SERVER_OPS_MEMORY_H_

#include <cstdint>
#include <string>

namespace traverse {

// The memory that this process may use: the least of the limits of its control groups (version 1 or
// 2) and the machine's memory. `root` is the folder of /proc and /sys, for tests.
int64_t MemoryLimit(const std::string& root = "");

// Memory that only this process uses, in bytes; 0 if unknown. Takes some microseconds.
int64_t ResidentBytes();

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_MEMORY_H_
