#include "engine/geometry/nearest_point_index.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/base/rest.h"

namespace traverse {
namespace {

// Puts a zero bit between each two of the lower 16 bits.
uint32_t Spread(uint32_t x) {
  x &= 0xffff;
  x = (x | (x << 8)) & 0x00ff00ff;
  x = (x | (x << 4)) & 0x0f0f0f0f;
  x = (x | (x << 2)) & 0x33333333;
  x = (x | (x << 1)) & 0x55555555;
  return x;
}

// Sorts by the upper 32 bits and keeps the order of equal ones: a radix sort, because that can be
// done piece by piece.
void SortByUpperHalf(std::vector<uint64_t>& keys, Rest& rest) {
  constexpr int kDigitBits = 11;
  constexpr size_t kDigits = size_t{1} << kDigitBits;
  constexpr size_t kMinSize = 1 << 12;
  if (keys.size() < kMinSize) return std::sort(keys.begin(), keys.end());
  std::vector<uint64_t> sorted(keys.size());
  for (int shift = 32; shift < 64; shift += kDigitBits) {
    const auto digit = [shift](uint64_t key) { return (key >> shift) & (kDigits - 1); };
    std::array<size_t, kDigits + 1> begin{};
    for (const uint64_t key : keys) {
      ++begin[digit(key) + 1];
      rest();
    }
    for (size_t d = 0; d < kDigits; ++d) begin[d + 1] += begin[d];
    for (const uint64_t key : keys) {
      sorted[begin[digit(key)]++] = key;
      rest();
    }
    std::swap(keys, sorted);
  }
}

// The points' ids in the order of their places on a Morton curve over a grid of 65536 x 65536.
std::vector<int> MortonOrder(const std::vector<Point>& points, Rest& rest) {
  const BoundingBox box((absl::MakeConstSpan(points)));
  const double size = std::max({box.width(), box.height(), std::numeric_limits<double>::min()});
  const auto cell = [&](double offset) { return static_cast<uint32_t>(offset / size * 65535); };
  std::vector<uint64_t> keys;
  keys.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    rest(2);
    const uint64_t code =
        Spread(cell(points[i].x - box.low().x)) | (Spread(cell(points[i].y - box.low().y)) << 1);
    keys.push_back(code << 32 | i);
  }
  SortByUpperHalf(keys, rest);
  std::vector<int> ids;
  ids.reserve(points.size());
  for (const uint64_t key : keys) ids.push_back(static_cast<int>(key & 0xffffffff));
  return ids;
}

}  // namespace

NearestPointIndex::NearestPointIndex(std::vector<Point> points, Budget* budget)
    : count_(static_cast<int>(points.size())),
      in_set_(points.size() + 1, 1),
      place_(points.size()) {
  Rest rest(budget);
  if (!points.empty()) ids_ = MortonOrder(points, rest);
  while (leaves_ * kLeafSize < points.size()) leaves_ *= 2;
  boxes_.resize(2 * leaves_);
  least_id_.resize(2 * leaves_, kNone);
  points_.reserve(points.size());
  for (size_t place = 0; place < ids_.size(); ++place) {
    rest(8);
    const Point point = points[static_cast<size_t>(ids_[place])];
    points_.push_back(point);
    place_[static_cast<size_t>(ids_[place])] = static_cast<int>(place);
    const size_t leaf = leaves_ + place / kLeafSize;
    boxes_[leaf].Add(point);
    least_id_[leaf] = std::min(least_id_[leaf], ids_[place]);
  }
  for (size_t node = leaves_; node-- > 1;) {
    rest(4);
    boxes_[node].Add(boxes_[2 * node]);
    boxes_[node].Add(boxes_[2 * node + 1]);
    least_id_[node] = std::min(least_id_[2 * node], least_id_[2 * node + 1]);
  }
}

void NearestPointIndex::Change(int id, int by) {
  const size_t place = static_cast<size_t>(place_[static_cast<size_t>(id)]);
  assert(in_set_[place] == (by > 0 ? 0 : 1));
  in_set_[place] = by > 0 ? 1 : 0;
  count_ += by;
  if (!searching_) {
    if (by > 0) first_ = std::min(first_, place);
    return;
  }
  size_t node = leaves_ + place / kLeafSize;
  least_id_[node] = LeastIdOfLeaf(node);
  while ((node /= 2) > 0) least_id_[node] = std::min(least_id_[2 * node], least_id_[2 * node + 1]);
}

int NearestPointIndex::LeastIdOfLeaf(size_t leaf) const {
  const size_t begin = (leaf - leaves_) * kLeafSize;
  const size_t end = std::min(begin + kLeafSize, points_.size());
  int least = kNone;
  for (size_t place = begin; place < end; ++place) {
    if (in_set_[place]) least = std::min(least, ids_[place]);
  }
  return least;
}

int NearestPointIndex::Nearest(Point p) const {
  struct Open {
    size_t node;
    double bound;
  };
  // One sibling per level waits, and there are fewer than 64 levels.
  std::array<Open, 64> open;
  size_t opened = 0;
  double least = std::numeric_limits<double>::infinity();
  int nearest = -1;
  if (size() > 0) open[opened++] = {1, 0};
  while (opened > 0) {
    auto [node, bound] = open[--opened];
    // A box as far away as the nearest point may hold one with a smaller id.
    if (bound > least || (bound == least && least_id_[node] > nearest)) continue;
    while (node < leaves_) {
      Open near{2 * node, boxes_[2 * node].SquaredDistanceTo(p)};
      Open far{2 * node + 1, boxes_[2 * node + 1].SquaredDistanceTo(p)};
      const int near_id = least_id_[near.node];
      const int far_id = least_id_[far.node];
      if (near_id == kNone ||
          (far_id != kNone && std::pair(far.bound, far_id) < std::pair(near.bound, near_id))) {
        std::swap(near, far);
      }
      if (least_id_[far.node] != kNone && far.bound <= least) open[opened++] = far;
      node = near.node;
    }
    ScanLeaf(node, p, least, nearest);
  }
  return nearest;
}

void NearestPointIndex::ScanLeaf(size_t leaf, Point p, double& least, int& nearest) const {
  const size_t begin = (leaf - leaves_) * kLeafSize;
  const size_t end = std::min(begin + kLeafSize, points_.size());
  for (size_t place = begin; place < end; ++place) {
    if (!in_set_[place]) continue;
    const double distance = SquaredDistance(ids_[place], p);
    if (distance < least || (distance == least && ids_[place] < nearest)) {
      least = distance;
      nearest = ids_[place];
    }
  }
}

int NearestPointIndex::Any() const {
  if (size() == 0) return -1;
  if (!searching_) {
    while (!in_set_[first_]) ++first_;
    return ids_[first_];
  }
  size_t node = 1;
  while (node < leaves_) node = 2 * node + (least_id_[2 * node] != kNone ? 0 : 1);
  size_t place = (node - leaves_) * kLeafSize;
  while (!in_set_[place]) ++place;
  return ids_[place];
}

}  // namespace traverse
