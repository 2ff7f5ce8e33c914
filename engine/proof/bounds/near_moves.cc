#include "engine/proof/bounds/near_moves.h"

#include "engine/base/at.h"

namespace traverse {

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

void NearMoves::AddPair(int junction, const Junction::Member& a, const Junction::Member& b) {
  if (Find(a.end, b.end) != nullptr) return;
  groups_of_[At(a.end)].emplace_back(b.end, groups_.size());
  groups_of_[At(b.end)].emplace_back(a.end, groups_.size());
  const int base = first_side(junction);
  const size_t begin = moves_.size();
  int from = first(a.end);
  for (const Point& p : graph_.ends[At(a.end)].points) {
    int to = first(b.end);
    for (const Point& q : graph_.ends[At(b.end)].points) {
      moves_.push_back({{from, to++}, cost_.Base(p, q)});
    }
    ++from;
  }
  groups_.push_back({{base + a.side, base + b.side}, begin, moves_.size()});
}

const NearMoves::Group* NearMoves::Find(int a, int b) const {
  for (const auto& [other, group] : groups_of_[At(a)]) {
    if (other == b) return &groups_[group];
  }
  return nullptr;
}

}  // namespace traverse
