// How much text a container may hold.

#ifndef TRAVERSE_CLIENT_CONTAINERS_LIMITS_H_
#define TRAVERSE_CLIENT_CONTAINERS_LIMITS_H_

#include <algorithm>
#include <cstddef>

namespace traverse::containers {

// Most bytes of text in a container of `container_bytes`, if a caller accepts `max_bytes`.
inline size_t MaxTextBytes(size_t container_bytes, size_t max_bytes) {
  constexpr size_t kAlways = size_t{64} << 20;
  constexpr size_t kMaxRatio = 256;
  return std::min(max_bytes, std::max(kAlways, kMaxRatio * container_bytes));
}

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_LIMITS_H_
