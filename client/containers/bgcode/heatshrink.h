// Heatshrink: LZSS for small machines (github.com/atomicobject/heatshrink describes it).
//
// A stream of bits, the highest of each byte first. 1 and 8 bits are a literal byte; 0, then
// `window_bits` of distance - 1 and `lookahead_bits` of length - 1, repeat earlier output. Whatever
// would lie before the beginning is zeros. The last byte is padded with zeros.
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

// The `size` bytes from which `bytes` were compressed. InvalidArgument if `bytes` end before that,
// or continue after it. Allocates at most 8 times bytes.size() (with lookahead 4).
absl::StatusOr<std::string> HeatshrinkDecompress(std::string_view bytes, HeatshrinkWindow window,
                                                 size_t size);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_BGCODE_HEATSHRINK_H_
