// Heatshrink: LZSS for small machines (github.com/atomicobject/heatshrink has its description).
//
// A stream of bits, the highest of each byte first: 1 and 8 bits are a byte as it is; 0, then
// `window_bits` of distance - 1 and `lookahead_bits` of length - 1 repeat what was written before.
// What would lie before the beginning is zeros. The last byte is filled up with zeros.
//
// Linear time. Longest repeat: 2^lookahead_bits bytes from 2^window_bits bytes back.

#ifndef TRAVERSE_CLIENT_CONTAINERS_BGCODE_HEATSHRINK_H_
#define TRAVERSE_CLIENT_CONTAINERS_BGCODE_HEATSHRINK_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace traverse::containers {

struct HeatshrinkWindow {
  int window_bits = 12;    // 4 to 15
  int lookahead_bits = 4;  // 3 to window_bits - 1
};

// `bytes`, compressed.
std::string HeatshrinkCompress(std::string_view bytes, HeatshrinkWindow window);

// The `size` bytes that `bytes` were before they were compressed. InvalidArgument if `bytes` end
// before that, or go on behind it. Allocates no more than 8 (lookahead of 4) times bytes.size().
absl::StatusOr<std::string> HeatshrinkDecompress(std::string_view bytes, HeatshrinkWindow window,
                                                 size_t size);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_BGCODE_HEATSHRINK_H_
