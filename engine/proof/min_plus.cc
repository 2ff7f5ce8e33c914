#include "engine/proof/min_plus.h"

#include <cstddef>

// Four sums at a time where the processor has AVX2, chosen when the program is loaded. The results
// are the same: there is nothing to reassociate. Sanitizers cannot run before such a choice is
// made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TRAVERSE_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define TRAVERSE_VECTOR_CLONES
#endif

namespace traverse {

TRAVERSE_VECTOR_CLONES
void MinPlus(const double* from, int from_count, double offset, const double* moves, double* to,
             int to_count) {
  for (int u = 0; u < from_count; ++u) {
    if (from[u] == kUnreached) continue;
    const double cost = from[u] + offset;
    const double* row = moves + static_cast<ptrdiff_t>(u) * to_count;
    for (int v = 0; v < to_count; ++v) {
      const double sum = cost + row[v];
      to[v] = sum < to[v] ? sum : to[v];
    }
  }
}

void ElementwiseMin(const double* from, double* to, int count) {
  for (int v = 0; v < count; ++v) to[v] = from[v] < to[v] ? from[v] : to[v];
}

}  // namespace traverse
