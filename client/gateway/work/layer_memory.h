// How much memory the work on layers that come as JSON may take.

#ifndef TRAVERSE_CLIENT_GATEWAY_WORK_LAYER_MEMORY_H_
#define TRAVERSE_CLIENT_GATEWAY_WORK_LAYER_MEMORY_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "client/gateway/spool/spool.h"

namespace traverse::gateway {

// By its length, its objects and its values: for the text, the messages made of it, the search and
// the answers. It is gone through for that, unpacked if it is packed. OutOfRange if it holds more
// than `max_bytes`.
absl::StatusOr<int64_t> MemoryForLayers(const SpoolFile& json, uint64_t max_bytes);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_WORK_LAYER_MEMORY_H_
