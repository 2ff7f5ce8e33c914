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

// From now on blocks of 4 MiB or more go back to the system as soon as they are freed. By itself
// the allocator keeps those of up to 32 MiB once it has seen one, for each of its arenas, and
// nobody counts them. For programs that go on running; before the first thread begins.
void GiveLargeBlocksBack();

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_MEMORY_H_
