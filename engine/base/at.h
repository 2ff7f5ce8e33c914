// Numbers of paths, points and entries are ints, as -1 often stands for none; vectors count in
// size_t.

#ifndef TRAVERSE_ENGINE_BASE_AT_H_
#define TRAVERSE_ENGINE_BASE_AT_H_

#include <cassert>
#include <cstddef>

namespace traverse {

// REQUIRES: index >= 0.
inline size_t At(int index) {
  assert(index >= 0);
  return static_cast<size_t>(index);
}

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_AT_H_
