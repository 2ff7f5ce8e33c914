#include "client/warm_start/point_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

namespace traverse {
namespace {

double SquareTo(const OwnedPoint& point, double x, double y) {
  return (point.x - x) * (point.x - x) + (point.y - y) * (point.y - y);
}

}  // namespace

PointTree::PointTree(std::vector<OwnedPoint> points)
    : points_(std::move(points)), left_(points_.size()), removed_(points_.size()) {
  assert(std::all_of(points_.begin(), points_.end(), [](const OwnedPoint& point) {
    return std::isfinite(point.x) && std::isfinite(point.y);
  }));
  Build({0, points_.size(), true});
  for (size_t i = 0; i < points_.size(); ++i) {
    const auto owner = static_cast<size_t>(points_[i].owner);
    if (owner >= positions_.size()) positions_.resize(owner + 1);
    positions_[owner].push_back(i);
  }
}

void PointTree::Build(Range range) {
  if (range.begin == range.end) return;
  const auto at = [&](size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(
      at(range.begin), at(range.middle()), at(range.end),
      [&](const OwnedPoint& a, const OwnedPoint& b) { return range.by_x ? a.x < b.x : a.y < b.y; });
  left_[range.middle()] = static_cast<int>(range.end - range.begin);
  Build(range.below());
  Build(range.above());
}

void PointTree::Remove(int owner) {
  if (static_cast<size_t>(owner) >= positions_.size()) return;
  for (const size_t position : positions_[static_cast<size_t>(owner)]) {
    if (removed_[position]) continue;
    removed_[position] = true;
    Range range = {0, points_.size(), true};
    while (true) {
      --left_[range.middle()];
      if (position == range.middle()) break;
      range = position < range.middle() ? range.below() : range.above();
    }
  }
}

const OwnedPoint* PointTree::Nearest(double x, double y) const {
  Best best;
  Look({0, points_.size(), true}, x, y, best);
  return best.point;
}

void PointTree::Look(Range range, double x, double y, Best& best) const {
  if (range.begin == range.end || left_[range.middle()] == 0) return;
  const OwnedPoint& point = points_[range.middle()];
  if (!removed_[range.middle()]) {
    const double square = SquareTo(point, x, y);
    if (best.point == nullptr || std::tie(square, point.owner, point.vertex) <
                                     std::tie(best.square, best.point->owner, best.point->vertex)) {
      best = {&point, square};
    }
  }
  const double beyond = range.by_x ? x - point.x : y - point.y;
  Look(beyond < 0 ? range.below() : range.above(), x, y, best);
  if (best.point == nullptr || beyond * beyond <= best.square) {
    Look(beyond < 0 ? range.above() : range.below(), x, y, best);
  }
}

std::vector<OwnedPoint> PointTree::Within(double x, double y, double radius) const {
  std::vector<OwnedPoint> found;
  Collect({0, points_.size(), true}, x, y, radius * radius, found);
  return found;
}

void PointTree::Collect(Range range, double x, double y, double square,
                        std::vector<OwnedPoint>& found) const {
  if (range.begin == range.end || left_[range.middle()] == 0) return;
  const OwnedPoint& point = points_[range.middle()];
  if (!removed_[range.middle()] && SquareTo(point, x, y) <= square) found.push_back(point);
  const double beyond = range.by_x ? x - point.x : y - point.y;
  const bool near = beyond * beyond <= square;
  if (beyond <= 0 || near) Collect(range.below(), x, y, square, found);
  if (beyond >= 0 || near) Collect(range.above(), x, y, square, found);
}

}  // namespace traverse
