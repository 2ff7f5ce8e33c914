#include "engine/proof/vertices/near_moves.h"

#include "engine/base/at.h"

namespace traverse {

NearMoves::NearMoves(const EndGraph& graph, const TravelCost& cost, size_t most_of_end)
    : cost_(cost), places_(graph, most_of_end), first_side_(1, 0), groups_of_(graph.ends.size()) {
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
  for (int p = first(a.end); p < first(a.end + 1); ++p) {
    for (int q = first(b.end); q < first(b.end + 1); ++q) moves_.push_back({{p, q}, Cost(p, q)});
  }
  groups_.push_back({junction,
                     {a.end, b.end},
                     {base + a.side, base + b.side},
                     begin,
                     moves_.size(),
                     line_count_});
  line_count_ += At(size(a.end) + size(b.end));
}

std::vector<int> NearMoves::Split(const std::vector<char>& marked, std::vector<size_t>& parents) {
  const std::vector<int> became = places_.Split(marked);
  const std::vector<Move> before = std::move(moves_);
  moves_.clear();
  parents.clear();
  line_count_ = 0;
  const auto parts = [&](int point) { return became[At(point) + 1] - became[At(point)]; };
  for (Group& group : groups_) {
    const size_t begin = moves_.size();
    const Move* first = &before[group.begin];
    const Move* const behind = first + (group.end - group.begin);
    while (first != behind) {
      const Move* row_end = first;
      while (row_end != behind && row_end->points[0] == first->points[0]) ++row_end;
      for (int p = became[At(first->points[0])]; p < became[At(first->points[0]) + 1]; ++p) {
        for (const Move* move = first; move != row_end; ++move) {
          const bool same = parts(move->points[0]) == 1 && parts(move->points[1]) == 1;
          for (int q = became[At(move->points[1])]; q < became[At(move->points[1]) + 1]; ++q) {
            moves_.push_back({{p, q}, same ? move->cost : Cost(p, q)});
            parents.push_back(static_cast<size_t>(move - before.data()));
          }
        }
      }
      first = row_end;
    }
    group.begin = begin;
    group.end = moves_.size();
    group.line = line_count_;
    line_count_ += At(size(group.ends[0]) + size(group.ends[1]));
  }
  return became;
}

const NearMoves::Group* NearMoves::Find(int a, int b) const {
  for (const auto& [other, group] : groups_of_[At(a)]) {
    if (other == b) return &groups_[group];
  }
  return nullptr;
}

}  // namespace traverse
