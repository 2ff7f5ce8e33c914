#include "engine/search/entries/entry_kernels.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>

// Sanitizers cannot follow the choice of a version at load time, clang has no such attribute for
// all its targets.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TRAVERSE_VECTOR_VERSIONS __attribute__((target_clones("avx2", "sse4.1", "default")))
#else
#define TRAVERSE_VECTOR_VERSIONS
#endif

namespace traverse {
namespace {

struct Length {
  [[gnu::always_inline]] float operator()(float length_mm) const { return length_mm; }
};

// Speeding up and slowing down as far as the speed is reached, and the rest at full speed.
struct Time {
  [[gnu::always_inline]] float operator()(float length_mm) const {
    const float ramps_mm = length_mm < time.full_speed_mm ? length_mm : time.full_speed_mm;
    const float retracted = length_mm > time.threshold_mm ? time.retraction : 0.0f;
    return 2 * std::sqrt(ramps_mm * time.per_accel) + (length_mm - ramps_mm) * time.per_mm +
           retracted;
  }

  FloatTime time;
};

// What follows an entry.
struct Nothing {
  [[gnu::always_inline]] float operator()(float, float, int) const { return 0; }
};

template <typename Cost>
struct Move {
  [[gnu::always_inline]] float operator()(float x, float y, int) const {
    const float dx = x - to.x;
    const float dy = y - to.y;
    return cost(std::sqrt(dx * dx + dy * dy));
  }

  FloatPoint to;
  Cost cost;
};

struct Tail {
  [[gnu::always_inline]] float operator()(float, float, int i) const { return tail[i]; }

  const float* tail;
};

// The low bits of a cost hold the number of its entry, so that the least is found without a branch:
// the bits of floats that are not negative are ordered as the floats.
constexpr int kBlock = 64;

template <typename Cost, typename Rest>
[[gnu::always_inline]] inline int32_t LeastKey(const FloatEntries& entries, int begin, int end,
                                               const Move<Cost>& reach, const Rest& rest) {
  int32_t least = std::numeric_limits<int32_t>::max();
  const float* const x = entries.x;
  const float* const y = entries.y;
  for (int i = begin; i < end; ++i) {
    const float value = reach(x[i], y[i], i) + rest(x[i], y[i], i);
    const int32_t key = (std::bit_cast<int32_t>(value) & ~(kBlock - 1)) | (i - begin);
    least = key < least ? key : least;
  }
  return least;
}

template <typename Cost, typename Rest>
[[gnu::always_inline]] inline int Best(const FloatEntries& entries, const Move<Cost>& reach,
                                       const Rest& rest) {
  assert(entries.n > 0);
  int best = 0;
  int32_t least = std::numeric_limits<int32_t>::max();
  for (int begin = 0; begin < entries.n; begin += kBlock) {
    const int end = std::min(entries.n, begin + kBlock);
    const int32_t key = LeastKey(entries, begin, end, reach, rest);
    if ((key | (kBlock - 1)) >= (least | (kBlock - 1))) continue;
    least = key;
    best = begin + (key & (kBlock - 1));
  }
  return best;
}

template <typename Cost>
[[gnu::always_inline]] inline void Fill(const FloatEntries& entries, const Move<Cost>& rest,
                                        float* tail) {
  for (int i = 0; i < entries.n; ++i) tail[i] = rest(entries.x[i], entries.y[i], i);
}

// The distance from a point to a box.
[[gnu::always_inline]] inline float DistanceTo(const FloatBox& box, float x, float y) {
  const float left = box.low.x - x;
  const float right = x - box.high.x;
  const float below = box.low.y - y;
  const float above = y - box.high.y;
  float dx = left > right ? left : right;
  float dy = below > above ? below : above;
  dx = dx > 0 ? dx : 0;
  dy = dy > 0 ? dy : 0;
  return std::sqrt(dx * dx + dy * dy);
}

template <typename Cost>
[[gnu::always_inline]] inline void FillLeast(const FloatEntries& entries, const Move<Cost>& reach,
                                             const FloatBox& box, float least_tail, float* bound) {
  for (int i = 0; i < entries.n; ++i) {
    const float x = entries.x[i];
    const float y = entries.y[i];
    bound[i] = reach(x, y, i) + reach.cost(DistanceTo(box, x, y)) + least_tail;
  }
}

}  // namespace

FloatTime::FloatTime(const CostSpec& spec)
    : per_mm(static_cast<float>(1 / spec.speed_mm_s)),
      per_accel(static_cast<float>(spec.accel_mm_s2 > 0 ? 1 / spec.accel_mm_s2 : 0)),
      full_speed_mm(static_cast<float>(
          spec.accel_mm_s2 > 0 ? spec.speed_mm_s * spec.speed_mm_s / spec.accel_mm_s2 : 0)),
      retraction(static_cast<float>(spec.retraction_seconds)),
      threshold_mm(static_cast<float>(spec.retraction_threshold_mm)) {}

TRAVERSE_VECTOR_VERSIONS
int BestBetween(const FloatEntries& entries, FloatPoint from, FloatPoint to,
                const FloatTime* time) {
  if (time == nullptr) return Best(entries, Move<Length>{from, {}}, Move<Length>{to, {}});
  return Best(entries, Move<Time>{from, {*time}}, Move<Time>{to, {*time}});
}

TRAVERSE_VECTOR_VERSIONS
int BestWithTail(const FloatEntries& entries, FloatPoint from, const float* tail,
                 const FloatTime* time) {
  if (time == nullptr) return Best(entries, Move<Length>{from, {}}, Tail{tail});
  return Best(entries, Move<Time>{from, {*time}}, Tail{tail});
}

TRAVERSE_VECTOR_VERSIONS
int BestFrom(const FloatEntries& entries, FloatPoint from, const FloatTime* time) {
  if (time == nullptr) return Best(entries, Move<Length>{from, {}}, Nothing{});
  return Best(entries, Move<Time>{from, {*time}}, Nothing{});
}

TRAVERSE_VECTOR_VERSIONS
void FillTail(const FloatEntries& entries, FloatPoint to, const FloatTime* time, float* tail) {
  if (time == nullptr) {
    Fill(entries, Move<Length>{to, {}}, tail);
  } else {
    Fill(entries, Move<Time>{to, {*time}}, tail);
  }
}

TRAVERSE_VECTOR_VERSIONS
void FillBounds(const FloatEntries& entries, FloatPoint from, const FloatBox& box, float least_tail,
                const FloatPoint* to, const FloatTime* time, float* bound) {
  if (time != nullptr) {
    FillLeast(entries, Move<Time>{from, {*time}}, box, least_tail, bound);
    return;
  }
  const Move<Length> reach{from, {}};
  FillLeast(entries, reach, box, least_tail, bound);
  if (to == nullptr) return;
  // No way over a contour is shorter than the straight one. Several moves without a retraction may
  // be faster, though.
  const Move<Length> rest{*to, {}};
  for (int i = 0; i < entries.n; ++i) {
    const float straight =
        reach(entries.x[i], entries.y[i], i) + rest(entries.x[i], entries.y[i], i);
    bound[i] = straight > bound[i] ? straight : bound[i];
  }
}

}  // namespace traverse
