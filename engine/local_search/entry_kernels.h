// The inner loops over the entries of a contour, in single precision: enough to tell which is best.
//
// Written for the compiler to use vector instructions, the widest that the processor has. All
// processors give the same results, as each operation rounds the same way.

#ifndef TRAVERSE_ENGINE_LOCAL_SEARCH_ENTRY_KERNELS_H_
#define TRAVERSE_ENGINE_LOCAL_SEARCH_ENTRY_KERNELS_H_

#include "engine/model/cost_spec.h"

namespace traverse {

struct FloatPoint {
  float x, y;
};

// The entries i = 0 .. n - 1 are at (x[i], y[i]).
struct FloatEntries {
  const float* x;
  const float* y;
  int n;
};

// The cost of a length as TravelCost has it, in single precision and without branches.
struct FloatTime {
  explicit FloatTime(const CostSpec& spec);

  float per_mm, per_accel, full_speed_mm, retraction, threshold_mm;
};

// The i for which the cost from `from` to entry i, and on from there, is least: to `to`, by
// tail[i], or nothing. `time`: null for a length. Of entries that cost the same up to 1e-5 of the
// cost, any. REQUIRES: n > 0.
int BestBetween(const FloatEntries& entries, FloatPoint from, FloatPoint to, const FloatTime* time);
int BestWithTail(const FloatEntries& entries, FloatPoint from, const float* tail,
                 const FloatTime* time);
int BestFrom(const FloatEntries& entries, FloatPoint from, const FloatTime* time);

// tail[i] = cost from entry i to `to`.
void FillTail(const FloatEntries& entries, FloatPoint to, const FloatTime* time, float* tail);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_LOCAL_SEARCH_ENTRY_KERNELS_H_
