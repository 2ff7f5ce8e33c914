// Deflate and CRC-32 of whole buffers, by zlib.

#ifndef TRAVERSE_CLIENT_CONTAINERS_DEFLATE_H_
#define TRAVERSE_CLIENT_CONTAINERS_DEFLATE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace traverse::containers {

// What surrounds deflated data: nothing (zip), or zlib's header and checksum (.bgcode).
enum class DeflateForm { kRaw, kZlib };

// Deflate expands one byte to at most this many.
inline constexpr size_t kMaxDeflateRatio = 1032;

// The `size` bytes from which `bytes` were deflated. InvalidArgument if they are damaged, or have
// more or fewer than `size`. Allocates nothing for an impossible size.
absl::StatusOr<std::string> Inflate(std::string_view bytes, DeflateForm form, size_t size);

// The same without keeping them, in pieces. Stops where there are more than `size`.
absl::Status InflateInPieces(std::string_view bytes, DeflateForm form, size_t size,
                             const std::function<void(std::string_view piece)>& sink);

// `bytes`, deflated; large ones in pieces on up to `threads` threads. The same bytes on any number
// of threads. `level` is zlib's: 1 to 9. ResourceExhausted if there is not enough memory.
absl::StatusOr<std::string> Deflate(std::string_view bytes, DeflateForm form, int level,
                                    int threads);

// CRC-32 with polynomial 0xEDB88320, as in zip and .bgcode.
uint32_t Crc32(std::string_view bytes);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_DEFLATE_H_
