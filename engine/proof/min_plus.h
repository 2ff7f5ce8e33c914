// The inner loop of the dynamic programmes over walks.

#ifndef TRAVERSE_ENGINE_PROOF_MIN_PLUS_H_
#define TRAVERSE_ENGINE_PROOF_MIN_PLUS_H_

#include <limits>

namespace traverse {

// The cost of a state that cannot, or need not, be reached.
inline constexpr double kUnreached = std::numeric_limits<double>::infinity();

// to[v] = min(to[v], from[u] + offset + moves[u * to_count + v]) over all u and v.
void MinPlus(const double* from, int from_count, double offset, const double* moves, double* to,
             int to_count);

// to[v] = min(to[v], from[v]).
void ElementwiseMin(const double* from, double* to, int count);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_MIN_PLUS_H_
