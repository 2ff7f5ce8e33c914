#include "engine/local_search/leaf_entries.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/geometry/bounding_box.h"

namespace traverse {
namespace {

// Cost of a length in single precision, without branches. Same formulas as TravelCost.
struct FloatLength {
  float operator()(float length_mm) const { return length_mm; }
};

struct FloatTime {
  explicit FloatTime(const CostSpec& spec)
      : per_mm(static_cast<float>(1 / spec.speed_mm_s)),
        per_accel(static_cast<float>(spec.accel_mm_s2 > 0 ? 1 / spec.accel_mm_s2 : 0)),
        full_speed_mm(static_cast<float>(
            spec.accel_mm_s2 > 0 ? spec.speed_mm_s * spec.speed_mm_s / spec.accel_mm_s2 : 0)),
        retraction(static_cast<float>(spec.retraction_seconds)),
        threshold_mm(static_cast<float>(spec.retraction_threshold_mm)) {}

  // Speeding up and slowing down as far as the speed is reached, and the rest at full speed.
  float operator()(float length_mm) const {
    const float ramps_mm = length_mm < full_speed_mm ? length_mm : full_speed_mm;
    const float retracted = length_mm > threshold_mm ? retraction : 0.0f;
    return 2 * std::sqrt(ramps_mm * per_accel) + (length_mm - ramps_mm) * per_mm + retracted;
  }

  float per_mm, per_accel, full_speed_mm, retraction, threshold_mm;
};

struct FloatPoint {
  float x, y;
};

// Entries are told apart in the low bits of their costs, so that the least one is found without a
// branch: the bits of floats that are not negative are ordered as the floats.
constexpr int kBlock = 64;

// The key of the cheapest of entries 0 to n - 1: its cost, with its index in the low bits. Written
// for the compiler to use vector instructions: four times the speed. REQUIRES: n <= kBlock.
template <bool kHasNext, typename Cost>
int32_t LeastKey(const float* x, const float* y, int n, FloatPoint from, FloatPoint to, Cost cost) {
  int32_t least = std::numeric_limits<int32_t>::max();
  for (int i = 0; i < n; ++i) {
    const float ax = x[i] - from.x;
    const float ay = y[i] - from.y;
    float value = cost(std::sqrt(ax * ax + ay * ay));
    if constexpr (kHasNext) {
      const float bx = x[i] - to.x;
      const float by = y[i] - to.y;
      value += cost(std::sqrt(bx * bx + by * by));
    }
    const int32_t key = (std::bit_cast<int32_t>(value) & ~(kBlock - 1)) | i;
    least = key < least ? key : least;
  }
  return least;
}

template <bool kHasNext, typename Cost>
int BestOf(const float* x, const float* y, int n, FloatPoint from, FloatPoint to, Cost cost) {
  int best = 0;
  int32_t least = std::numeric_limits<int32_t>::max();
  for (int begin = 0; begin < n; begin += kBlock) {
    const int32_t key =
        LeastKey<kHasNext>(x + begin, y + begin, std::min(n - begin, kBlock), from, to, cost);
    if ((key | (kBlock - 1)) >= (least | (kBlock - 1))) continue;
    least = key;
    best = begin + (key & (kBlock - 1));
  }
  return best;
}

}  // namespace

LeafEntries::LeafEntries(const LayerProblem& problem) {
  BoundingBox box;
  box.Add(problem.start);
  for (const Path& path : problem.plan->paths) box.Add(BoundingBox(path.points));
  origin_ = box.center();
  for (const Path& path : problem.plan->paths) AddPath(path);
  AddEntry(problem.start, problem.start, 0);
  CloseLeaf(1, false);
  const Point finish = problem.finish.value_or(problem.start);
  AddEntry(finish, finish, 0);
  CloseLeaf(1, false);
}

void LeafEntries::AddPath(const Path& path) {
  const auto point = [&path](int i) { return path.points[Index(i)]; };
  if (path.kind == Path::Kind::kOpen) {
    AddEntry(point(0), point(1), 0);
    if (!path.one_way) AddEntry(point(1), point(0), 1);
    CloseLeaf(path.one_way ? 1 : 2, true);
    return;
  }
  const int count =
      static_cast<int>(path.allowed.empty() ? path.points.size() : path.allowed.size());
  for (int i = 0; i < count; ++i) {
    const int vertex = path.allowed.empty() ? i : path.allowed[Index(i)];
    AddEntry(point(vertex), point(vertex), vertex);
  }
  CloseLeaf(count, false);
}

void LeafEntries::AddEntry(Point enter, Point exit, int visit_entry) {
  enter_.push_back(enter);
  exit_.push_back(exit);
  visit_entry_.push_back(visit_entry);
  x_.push_back(static_cast<float>(enter.x - origin_.x));
  y_.push_back(static_cast<float>(enter.y - origin_.y));
}

void LeafEntries::CloseLeaf(int count, bool open) {
  const int first = static_cast<int>(enter_.size()) - count;
  first_.push_back(first);
  count_.push_back(count);
  open_.push_back(open);
  if (open || count == 1) {
    radius_.push_back(0);
    return;
  }
  const BoundingBox box(absl::MakeConstSpan(enter_).subspan(Index(first)));
  radius_.push_back(std::max(box.width(), box.height()) / 2);
  for (int i = count; i % kLanes != 0; ++i)
    AddEntry(enter_.back(), exit_.back(), visit_entry_.back());
}

int LeafEntries::EntryOf(const Visit& visit) const {
  const auto begin = visit_entry_.begin() + first(visit.path);
  const auto end = begin + count(visit.path);
  return first(visit.path) + static_cast<int>(std::find(begin, end, visit.entry) - begin);
}

int LeafEntries::Best(int leaf, Point from, const Point* to, const TravelCost& cost) const {
  const int n = count(leaf);
  const int e = first(leaf);
  if (n == 1) return e;
  if (!open(leaf)) return BestOfContour(leaf, from, to, cost);
  const auto total = [&](int entry) {
    return cost(from, enter(entry)) + (to != nullptr ? cost(exit(entry), *to) : 0);
  };
  return total(e + 1) < total(e) ? e + 1 : e;
}

int LeafEntries::BestOfContour(int leaf, Point from, const Point* to,
                               const TravelCost& cost) const {
  const int e = first(leaf);
  const int n = (count(leaf) + kLanes - 1) / kLanes * kLanes;
  const float* x = x_.data() + e;
  const float* y = y_.data() + e;
  const auto relative = [this](Point p) {
    return FloatPoint{static_cast<float>(p.x - origin_.x), static_cast<float>(p.y - origin_.y)};
  };
  const FloatPoint a = relative(from);
  const FloatPoint b = to != nullptr ? relative(*to) : a;
  int best;
  if (cost.is_length()) {
    best = to != nullptr ? BestOf<true>(x, y, n, a, b, FloatLength())
                         : BestOf<false>(x, y, n, a, b, FloatLength());
  } else {
    const FloatTime time(cost.spec());
    best = to != nullptr ? BestOf<true>(x, y, n, a, b, time) : BestOf<false>(x, y, n, a, b, time);
  }
  return e + std::min(best, count(leaf) - 1);
}

}  // namespace traverse
