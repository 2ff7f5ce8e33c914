// The inner loops over the entries of a contour, in single precision: enough to tell which is best.
//
// Written for the compiler to use vector instructions, the widest that the processor has. All
// processors give the same results, as each operation rounds the same way.

#ifndef TRAVERSE_ENGINE_SEARCH_ENTRIES_ENTRY_KERNELS_H_
#define TRAVERSE_ENGINE_SEARCH_ENTRIES_ENTRY_KERNELS_H_

#include "engine/geometry/float_points.h"
#include "engine/model/cost_spec.h"

namespace traverse {

struct FloatBox {
  FloatPoint low{0, 0}, high{0, 0};
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

// bound[i] = what it costs at least to go from `from` to entry i, on to a point of `box`, and from
// there either what `least_tail` says or, by length, to `to`. `to`: null if that is anywhere.
void FillBounds(const FloatEntries& entries, FloatPoint from, const FloatBox& box, float least_tail,
                const FloatPoint* to, const FloatTime* time, float* bound);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_ENTRIES_ENTRY_KERNELS_H_
