#include "client/gcode/precedence.h"

#include <algorithm>
#include <numeric>

#include "absl/container/flat_hash_set.h"
#include "client/gcode/segment_grid.h"

namespace traverse::gcode {
namespace {

class UnionFind {
 public:
  explicit UnionFind(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

  uint32_t Find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(uint32_t i, uint32_t j) { parent_[Find(i)] = Find(j); }

 private:
  std::vector<uint32_t> parent_;
};

std::vector<Segment> AllSegments(const std::vector<Outline>& outlines) {
  std::vector<Segment> segments;
  for (size_t path = 0; path < outlines.size(); ++path) {
    const std::vector<Vertex>& points = outlines[path].points;
    for (size_t k = 0; k + 1 < points.size(); ++k) {
      segments.push_back(Segment{points[k], points[k + 1], static_cast<uint32_t>(path)});
    }
  }
  return segments;
}

// Between the boxes of two segments, along x or y: no more than their distance.
double Gap(const Segment& s, const Segment& t) {
  const auto gap = [](double a, double b, double c, double d) {
    return std::max(std::min(a, b) - std::max(c, d), std::min(c, d) - std::max(a, b));
  };
  return std::max(gap(s.a.x, s.b.x, t.a.x, t.b.x), gap(s.a.y, s.b.y, t.a.y, t.b.y));
}

std::vector<uint32_t> Numbered(UnionFind& regions, size_t n) {
  std::vector<uint32_t> number(n, UINT32_MAX);
  std::vector<uint32_t> island(n);
  uint32_t next = 0;
  for (uint32_t i = 0; i < n; ++i) {
    uint32_t& of_root = number[regions.Find(i)];
    if (of_root == UINT32_MAX) of_root = next++;
    island[i] = of_root;
  }
  return island;
}

}  // namespace

Contacts FindContacts(const std::vector<Outline>& outlines,
                      const std::function<bool(uint32_t, uint32_t)>& keeps_order) {
  Contacts contacts;
  UnionFind regions(outlines.size());
  absl::flat_hash_set<std::pair<uint32_t, uint32_t>> known;
  const SegmentGrid grid(AllSegments(outlines));
  grid.ForEachNearPair([&](uint32_t s, uint32_t t) {
    const Segment& one = grid.segments()[s];
    const Segment& other = grid.segments()[t];
    const double reach = kTouch * (outlines[one.path].width_mm + outlines[other.path].width_mm) / 2;
    // Most pairs are told apart here: what is near is in the next cell, and a cell is wide.
    if (Gap(one, other) > reach) return;
    const uint32_t i = std::min(one.path, other.path);
    const uint32_t j = std::max(one.path, other.path);
    const bool joined = regions.Find(i) == regions.Find(j);
    const bool ordered = keeps_order(i, j);
    if (joined && (!ordered || known.contains({i, j}))) return;
    if (SquaredDistance(one, other) > reach * reach) return;
    regions.Join(i, j);
    if (ordered && known.insert({i, j}).second) contacts.ordered.push_back({i, j});
  });
  std::sort(contacts.ordered.begin(), contacts.ordered.end());
  contacts.island = Numbered(regions, outlines.size());
  return contacts;
}

}  // namespace traverse::gcode
