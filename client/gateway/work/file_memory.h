// How much memory the work on a file may take, from what it says of itself.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_FILE_MEMORY_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_FILE_MEMORY_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "client/gateway/spool/spool.h"

namespace traverse::gateway {

// Whether `upload` is compressed or a container, so that its length says little.
bool IsPacked(const SpoolFile& upload);

// The memory that it takes to find out about a packed file.
int64_t MemoryToMeasure(const SpoolFile& upload);

// The memory that the work on `upload` may take. A packed file is gone through: some milliseconds
// for each of its megabytes. OutOfRange if it holds more than `max_file_bytes`; a file that is
// damaged counts as its length, and whoever reads it says what is wrong.
absl::StatusOr<int64_t> MemoryFor(const SpoolFile& upload, uint64_t max_file_bytes);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_FILE_MEMORY_H_
