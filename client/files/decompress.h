// Decompresses whole files: gzip (RFC 1952, with several members) and xz.
//
// A stream of xz states the memory that reading it takes. More than `xz -9` needs is refused, and
// so is a later stream that states more than the first, unless that is little.

#ifndef TRAVERSE_CLIENT_FILES_DECOMPRESS_H_
#define TRAVERSE_CLIENT_FILES_DECOMPRESS_H_

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace traverse {

enum class Compression { kNone, kGzip, kXz };

// The compression of `bytes`, judged by their first bytes.
Compression DetectCompression(std::string_view bytes);

// What reading `bytes` takes beside them and the result, in bytes, as their beginning states.
size_t DecoderBytes(std::string_view bytes, Compression compression);

// The decompressed `bytes`; with kNone a copy. InvalidArgument if they are truncated or damaged,
// ResourceExhausted if the result would be longer than `max_bytes`, or reading takes too much
// memory: a small file can expand a thousandfold and more.
absl::StatusOr<std::string> Decompress(std::string_view bytes, Compression compression,
                                       size_t max_bytes);

// The same without keeping the result: passes it on in pieces.
absl::Status DecompressInPieces(std::string_view bytes, Compression compression, size_t max_bytes,
                                const std::function<void(std::string_view piece)>& sink);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_DECOMPRESS_H_
