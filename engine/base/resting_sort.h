// Sorts long arrays piece by piece and asks a budget meanwhile.

#ifndef TRAVERSE_ENGINE_BASE_RESTING_SORT_H_
#define TRAVERSE_ENGINE_BASE_RESTING_SORT_H_

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "engine/base/rest.h"

namespace traverse {

// Sorts `values` completely, even if the budget of `rest` runs out. Equal elements end in an
// unspecified order that is the same each time. O(n log n); beyond a few thousand values it needs
// room for as many again. Source: bottom-up merging (Knuth, TAOCP 3, 5.2.4).
template <typename Value, typename Less = std::less<Value>>
void RestingSort(std::vector<Value>& values, Rest& rest, const Less& less = Less()) {
  constexpr size_t kPiece = 1 << 12;
  const size_t size = values.size();
  const auto at = [&](size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
  for (size_t begin = 0; begin < size; begin += kPiece) {
    const size_t end = std::min(size, begin + kPiece);
    rest(8 * (end - begin));
    std::sort(at(begin), at(end), less);
  }
  if (size <= kPiece) return;
  std::vector<Value> merged(size);
  for (size_t width = kPiece; width < size; width *= 2) {
    for (size_t begin = 0; begin < size; begin += 2 * width) {
      const size_t middle = std::min(size, begin + width);
      const size_t end = std::min(size, middle + width);
      size_t left = begin;
      size_t right = middle;
      for (size_t to = begin; to < end; ++to) {
        rest();
        const bool from_right =
            left == middle || (right < end && less(values[right], values[left]));
        merged[to] = std::move(values[from_right ? right++ : left++]);
      }
    }
    std::swap(values, merged);
  }
}

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_RESTING_SORT_H_
