#include "engine/proof/bounds/near_moves.h"

#include <algorithm>
#include <cassert>

namespace traverse {
namespace {

// Of pairs with more moves, those of each point to so many nearest ones of the other end.
constexpr size_t kMostMovesOfPair = 1024;
constexpr size_t kNearestOfPoint = 4;

size_t At(int index) { return static_cast<size_t>(index); }

// Marks the least `kNearestOfPoint` of `count` costs, each `step` behind the one before.
void MarkLeast(const double* costs, size_t count, size_t step, char* marked) {
  for (size_t times = 0; times < std::min(kNearestOfPoint, count); ++times) {
    size_t least = count;
    for (size_t i = 0; i < count; ++i) {
      if (marked[i * step] > static_cast<char>(times)) continue;
      if (least == count || costs[i * step] < costs[least * step]) least = i;
    }
    if (least < count) marked[least * step] = static_cast<char>(times + 1);
  }
}

}  // namespace

NearMoves::NearMoves(const EndGraph& graph, const TravelCost& cost)
    : graph_(graph), cost_(cost), first_(1, 0), first_side_(1, 0), groups_of_(graph.ends.size()) {
  for (size_t end = 0; end < graph.ends.size(); ++end) {
    end_of_.insert(end_of_.end(), graph.ends[end].points.size(), static_cast<int>(end));
    first_.push_back(point_count());
  }
  for (const Junction& junction : graph.junctions) {
    first_side_.push_back(first_side_.back() + junction.sides);
  }
}

void NearMoves::BeginGroup(int junction, const Junction::Member& a, const Junction::Member& b) {
  groups_of_[At(a.end)].emplace_back(b.end, groups_.size());
  groups_of_[At(b.end)].emplace_back(a.end, groups_.size());
  const int base = first_side(junction);
  groups_.push_back({{base + a.side, base + b.side}, moves_.size(), moves_.size()});
}

void NearMoves::Add(int from, int to, double cost) {
  moves_.push_back({{from, to}, cost});
  ++groups_.back().end;
}

void NearMoves::AddPair(int junction, const Junction::Member& a, const Junction::Member& b) {
  bool is_known = false;
  ForEachGroup(a.end, b.end, [&](const Group&) { is_known = true; });
  if (is_known) return;
  const auto& from = graph_.ends[At(a.end)].points;
  const auto& to = graph_.ends[At(b.end)].points;
  std::vector<double> costs;
  for (const Point& p : from) {
    for (const Point& q : to) costs.push_back(cost_.Base(p, q));
  }
  const bool has_all = costs.size() <= kMostMovesOfPair;
  std::vector<char> of_from(costs.size());
  std::vector<char> of_to(costs.size());
  for (size_t i = 0; !has_all && i < from.size(); ++i) {
    const size_t row = i * to.size();
    MarkLeast(costs.data() + row, to.size(), 1, of_from.data() + row);
  }
  for (size_t j = 0; !has_all && j < to.size(); ++j) {
    MarkLeast(costs.data() + j, from.size(), to.size(), of_to.data() + j);
  }
  BeginGroup(junction, a, b);
  for (size_t k = 0; k < costs.size(); ++k) {
    if (!has_all && of_from[k] == 0 && of_to[k] == 0) continue;
    Add(first(a.end) + static_cast<int>(k / to.size()),
        first(b.end) + static_cast<int>(k % to.size()), costs[k]);
  }
}

void NearMoves::AddMove(int junction, const Junction::Member& a, const Junction::Member& b,
                        std::array<int, 2> points) {
  assert(end_of(points[0]) == a.end && end_of(points[1]) == b.end);
  bool is_known = false;
  ForEachGroup(a.end, b.end, [&](const Group& group) {
    for (size_t i = group.begin; i < group.end; ++i) {
      const int* known = moves_[i].points;
      is_known = is_known || (std::minmax(known[0], known[1]) == std::minmax(points[0], points[1]));
    }
  });
  if (is_known) return;
  BeginGroup(junction, a, b);
  Add(points[0], points[1],
      cost_.Base(graph_.ends[At(a.end)].points[At(points[0] - first(a.end))],
                 graph_.ends[At(b.end)].points[At(points[1] - first(b.end))]));
}

}  // namespace traverse
