// How much memory the work on a file may take, from what it is made of.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_FILE_MEMORY_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_FILE_MEMORY_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "client/gateway/spool/spool.h"

namespace traverse::gateway {

// What is done with files. kOptimize: with layers as JSON.
enum class FileUse { kRewrite, kInspect, kVerify, kOptimize };

// Whether `upload` is so short that nobody waits while it is gone through.
bool IsMeasuredAtOnce(const SpoolFile& upload);

// The memory that it takes to find out what `upload` is made of.
int64_t MemoryToMeasure(const SpoolFile& upload);

// The memory that work of this kind on `upload` may take: more than it takes, and no more than
// double of it beyond the least that a file counts. Files are gone through for that, those in
// containers and compressed ones as they are when unpacked: some milliseconds for each megabyte.
// OutOfRange if one holds more than `max_file_bytes`; one that is damaged counts as far as it can
// be read, and whoever reads it says what is wrong.
//
// tests/chaos/weigh.py compares this with what is taken.
absl::StatusOr<int64_t> MemoryFor(const SpoolFile& upload, FileUse use, uint64_t max_file_bytes);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_FILE_MEMORY_H_
