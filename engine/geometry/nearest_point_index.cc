#include "engine/geometry/nearest_point_index.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <utility>

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

// The points' ids in the order of their places on a Morton curve over a grid of 65536 x 65536.
std::vector<int> MortonOrder(const std::vector<Point>& points) {
  const BoundingBox box((absl::MakeConstSpan(points)));
  const double size = std::max({box.width(), box.height(), std::numeric_limits<double>::min()});
  const auto cell = [&](double offset) { return static_cast<uint32_t>(offset / size * 65535); };
  std::vector<uint64_t> keys;
  keys.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const uint64_t code =
        Spread(cell(points[i].x - box.low().x)) | (Spread(cell(points[i].y - box.low().y)) << 1);
    keys.push_back(code << 32 | i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> ids;
  ids.reserve(points.size());
  for (const uint64_t key : keys) ids.push_back(static_cast<int>(key & 0xffffffff));
  return ids;
}

}  // namespace

NearestPointIndex::NearestPointIndex(std::vector<Point> points)
    : in_set_(points.size(), 1), place_(points.size()) {
  if (!points.empty()) ids_ = MortonOrder(points);
  while (leaves_ * kLeafSize < points.size()) leaves_ *= 2;
  boxes_.resize(2 * leaves_);
  count_.resize(2 * leaves_);
  points_.reserve(points.size());
  for (size_t place = 0; place < ids_.size(); ++place) {
    const Point point = points[static_cast<size_t>(ids_[place])];
    points_.push_back(point);
    place_[static_cast<size_t>(ids_[place])] = static_cast<int>(place);
    const size_t leaf = leaves_ + place / kLeafSize;
    boxes_[leaf].Add(point);
    ++count_[leaf];
  }
  for (size_t node = leaves_; node-- > 1;) {
    boxes_[node].Add(boxes_[2 * node]);
    boxes_[node].Add(boxes_[2 * node + 1]);
    count_[node] = count_[2 * node] + count_[2 * node + 1];
  }
}

void NearestPointIndex::Change(int id, int by) {
  const size_t place = static_cast<size_t>(place_[static_cast<size_t>(id)]);
  assert(in_set_[place] == (by > 0 ? 0 : 1));
  in_set_[place] = by > 0 ? 1 : 0;
  for (size_t node = leaves_ + place / kLeafSize; node > 0; node /= 2) count_[node] += by;
}

int NearestPointIndex::Nearest(Point p) const {
  struct Open {
    size_t node;
    double bound;
  };
  // One sibling is put aside a level, and there are fewer than 64 levels.
  std::array<Open, 64> open;
  size_t opened = 0;
  double least = std::numeric_limits<double>::infinity();
  int nearest = -1;
  if (size() > 0) open[opened++] = {1, 0};
  while (opened > 0) {
    auto [node, bound] = open[--opened];
    // A box as far away as the nearest point may hold one with a smaller id.
    if (bound > least) continue;
    while (node < leaves_) {
      Open near{2 * node, boxes_[2 * node].SquaredDistanceTo(p)};
      Open far{2 * node + 1, boxes_[2 * node + 1].SquaredDistanceTo(p)};
      if (count_[near.node] == 0 || (count_[far.node] > 0 && far.bound < near.bound)) {
        std::swap(near, far);
      }
      if (count_[far.node] > 0 && far.bound <= least) open[opened++] = far;
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
  size_t node = 1;
  while (node < leaves_) node = 2 * node + (count_[2 * node] > 0 ? 0 : 1);
  size_t place = (node - leaves_) * kLeafSize;
  while (!in_set_[place]) ++place;
  return ids_[place];
}

}  // namespace traverse
