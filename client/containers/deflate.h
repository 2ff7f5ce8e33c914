// Deflate and CRC-32 of whole buffers, by zlib.

#ifndef TRAVERSE_CLIENT_CONTAINERS_DEFLATE_H_
#define TRAVERSE_CLIENT_CONTAINERS_DEFLATE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace traverse::containers {

// What stands around deflated data: nothing (zip), or zlib's header and checksum (.bgcode).
enum class DeflateForm { kRaw, kZlib };

// Deflate makes at most so many bytes of one.
inline constexpr size_t kMaxDeflateRatio = 1032;

// The `size` bytes that `bytes` were before they were deflated. InvalidArgument if they are
// damaged, or are more or fewer than `size`. Takes no memory for a size that cannot be true.
absl::StatusOr<std::string> Inflate(std::string_view bytes, DeflateForm form, size_t size);

// `bytes`, deflated; large ones in pieces by up to `threads` threads. The same bytes on any number
// of threads. `level` is zlib's: 1 to 9. ResourceExhausted if there is no memory for it.
absl::StatusOr<std::string> Deflate(std::string_view bytes, DeflateForm form, int level,
                                    int threads);

// CRC-32 with polynomial 0xEDB88320, as zip and .bgcode have it.
uint32_t Crc32(std::string_view bytes);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_DEFLATE_H_
