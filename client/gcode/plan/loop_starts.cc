#include "client/gcode/plan/loop_starts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace traverse::gcode {
namespace {

// A wall may begin at corners at least this sharp, and nearly as sharp as its sharpest.
constexpr double kMinCornerRadians = 0.5;
constexpr double kCornerShare = 0.8;

// [k] how far along the loop its vertex k is; last, its whole length.
std::vector<double> LengthsUpTo(absl::Span<const Point> loop) {
  std::vector<double> lengths = {0};
  for (size_t k = 0; k < loop.size(); ++k) {
    lengths.push_back(lengths.back() + Distance(loop[k], loop[(k + 1) % loop.size()]));
  }
  return lengths;
}

}  // namespace

std::vector<uint32_t> SharpCorners(absl::Span<const Point> loop) {
  const size_t n = loop.size();
  std::vector<double> turn(n);
  double sharpest = 0;
  for (size_t k = 0; k < n; ++k) {
    const Point a = loop[(k + n - 1) % n];
    const Point b = loop[k];
    const Point c = loop[(k + 1) % n];
    const double cross = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
    const double dot = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y);
    turn[k] = std::abs(std::atan2(cross, dot));
    sharpest = std::max(sharpest, turn[k]);
  }
  std::vector<uint32_t> corners = {0};
  for (size_t k = 1; k < n; ++k) {
    if (turn[k] >= std::max(kMinCornerRadians, kCornerShare * sharpest)) {
      corners.push_back(static_cast<uint32_t>(k));
    }
  }
  return corners;
}

std::vector<uint32_t> ThinnedStarts(absl::Span<const Point> loop, std::vector<uint32_t> starts) {
  assert(!loop.empty());
  const bool all = starts.empty();
  if ((all ? loop.size() : starts.size()) <= kMostStarts) return starts;
  if (all) {
    starts.resize(loop.size());
    std::iota(starts.begin(), starts.end(), 0);
  }
  const std::vector<double> lengths = LengthsUpTo(loop);
  const double apart = lengths.back() / static_cast<double>(kMostStarts);
  std::vector<uint32_t> kept = {starts.front()};
  for (const uint32_t start : starts) {
    const double since = lengths[start] - lengths[kept.back()];
    if (since > 0 && since >= apart) kept.push_back(start);
  }
  return kept;
}

}  // namespace traverse::gcode
