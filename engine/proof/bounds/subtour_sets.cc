#include "engine/proof/bounds/subtour_sets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/at.h"

namespace traverse {
namespace {

constexpr int kMostIdleCalls = 3;

}  // namespace

// Of the pairs whose moves came in from `first_move` on.
void SubtourSets::FindMoves(Set& set, size_t first_move) const {
  const std::vector<int>& points = set.points;
  const auto behind = [&](size_t p) {  // the points of the same end
    const int end = moves_.end_of(points[p]);
    while (p < points.size() && moves_.end_of(points[p]) == end) ++p;
    return p;
  };
  for (size_t a = 0; a < points.size(); a = behind(a)) {
    for (size_t b = behind(a); b < points.size(); b = behind(b)) {
      const int ends[2] = {moves_.end_of(points[a]), moves_.end_of(points[b])};
      const NearMoves::Group* group = moves_.Find(ends[0], ends[1]);
      if (group == nullptr || group->begin < first_move) continue;
      for (size_t p = a; p < behind(a); ++p) {
        for (size_t q = b; q < behind(b); ++q) {
          set.within.push_back(moves_.IndexOf(*group, points[p], points[q]));
        }
      }
    }
  }
}

bool SubtourSets::Add(std::vector<int> points, const AverageSolution& average, double least) {
  std::sort(points.begin(), points.end());
  if (known_.contains(points)) return false;
  Set set;
  set.points = std::move(points);
  int whole = 0;  // ends
  int most_visited = -1;
  for (size_t p = 0; p < set.points.size();) {
    const int end = moves_.end_of(set.points[p]);
    size_t behind = p;
    while (behind < set.points.size() && moves_.end_of(set.points[behind]) == end) ++behind;
    const bool is_whole = behind - p == At(moves_.size(end));
    if (is_whole) ++whole;
    for (; p < behind; ++p) {
      const int point = set.points[p];
      if (is_whole) continue;
      set.subtracted.push_back(point);
      if (most_visited < 0 || average.points[At(point)] > average.points[At(most_visited)]) {
        most_visited = point;
      }
    }
  }
  set.constant = std::max(0, whole - 1);
  if (whole == 0) std::erase(set.subtracted, most_visited);
  FindMoves(set, 0);
  set.direction = -set.constant;
  for (const size_t i : set.within) set.direction += average.moves[i];
  for (const int point : set.subtracted) set.direction -= average.points[At(point)];
  if (set.direction < least) return false;
  known_.insert(set.points);
  sets_.push_back(std::move(set));
  moves_seen_ = moves_.moves().size();
  has_lists_ = false;
  return true;
}

void SubtourSets::AddNear(const NearMoves::Group& group) {
  const int* first = moves_.moves()[group.begin].points;
  const int ends[2] = {moves_.end_of(first[0]), moves_.end_of(first[1])};
  size_t of_end[2] = {};  // sets
  for (int k = 0; k < 2; ++k) {
    of_end[k] = sets_.size();
    const int other = ends[1 - k];
    for (int p = moves_.first(ends[k]); moves_.size(ends[k]) > 1 && p < moves_.first(ends[k] + 1);
         ++p) {
      Set set;
      for (int q = moves_.first(other); q < moves_.first(other + 1); ++q) set.points.push_back(q);
      set.points.insert(std::lower_bound(set.points.begin(), set.points.end(), p), p);
      set.subtracted.push_back(p);
      known_.insert(set.points);
      sets_.push_back(std::move(set));
    }
  }
  for (size_t i = group.begin; i < group.end; ++i) {
    for (int k = 0; k < 2; ++k) {
      if (moves_.size(ends[k]) == 1) continue;
      const int point = moves_.moves()[i].points[k];
      sets_[of_end[k] + At(point - moves_.first(ends[k]))].within.push_back(i);
    }
  }
  moves_seen_ = moves_.moves().size();
  has_lists_ = false;
}

void SubtourSets::AddNewMoves() {
  if (moves_seen_ == moves_.moves().size()) return;
  for (Set& set : sets_) FindMoves(set, moves_seen_);
  moves_seen_ = moves_.moves().size();
  has_lists_ = false;
}

double SubtourSets::Weigh(std::vector<double>& penalties, std::vector<double>& paid_back) const {
  penalties.assign(moves_.moves().size(), 0);
  paid_back.assign(At(moves_.point_count()), 0);
  double sum = 0;
  for (const Set& set : sets_) {
    if (set.multiplier <= 0) continue;
    sum -= set.multiplier * set.constant;
    for (const size_t i : set.within) penalties[i] += set.multiplier;
    for (const int point : set.subtracted) paid_back[At(point)] += set.multiplier;
  }
  return sum;
}

template <typename Of>
SubtourSets::Lists SubtourSets::ListsOf(size_t count, const Of& of) const {
  Lists lists;
  lists.begin.assign(count + 1, 0);
  for (const Set& set : sets_) {
    for (const auto i : of(set)) ++lists.begin[static_cast<size_t>(i) + 1];
  }
  for (size_t i = 0; i < count; ++i) lists.begin[i + 1] += lists.begin[i];
  lists.sets.resize(lists.begin[count]);
  std::vector<uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for (size_t s = 0; s < sets_.size(); ++s) {
    for (const auto i : of(sets_[s])) {
      lists.sets[next[static_cast<size_t>(i)]++] = static_cast<uint32_t>(s);
    }
  }
  return lists;
}

void SubtourSets::ListSets() {
  of_moves_ = ListsOf(
      moves_.moves().size(), [](const Set& set) -> const auto& { return set.within; });
  of_points_ = ListsOf(
      At(moves_.point_count()), [](const Set& set) -> const auto& { return set.subtracted; });
  has_lists_ = true;
}

void SubtourSets::Take(const std::vector<size_t>& moves, const std::vector<int>& points,
                       double weight) {
  if (!has_lists_) ListSets();
  for (Set& set : sets_) set.direction = (1 - weight) * set.direction - weight * set.constant;
  const auto add = [&](const Lists& lists, size_t of, double by) {
    for (uint32_t k = lists.begin[of]; k < lists.begin[of + 1]; ++k) {
      sets_[lists.sets[k]].direction += by;
    }
  };
  for (const size_t i : moves) add(of_moves_, i, weight);
  for (const int point : points) add(of_points_, At(point), -weight);
}

double SubtourSets::SquareOfDirection() const {
  double square = 0;
  for (const Set& set : sets_) {
    if (set.multiplier > 0 || set.direction > 0) square += set.direction * set.direction;
  }
  return square;
}

void SubtourSets::Step(double length) {
  for (Set& set : sets_) set.multiplier = std::max(0.0, set.multiplier + length * set.direction);
}

void SubtourSets::Keep() {
  for (Set& set : sets_) set.best_multiplier = set.multiplier;
}

void SubtourSets::GoBack() {
  for (Set& set : sets_) set.multiplier = set.best_multiplier;
}

void SubtourSets::DropIdle() {
  std::vector<Set> kept;
  for (Set& set : sets_) {
    set.idle = set.multiplier > 0 || set.best_multiplier > 0 ? 0 : set.idle + 1;
    if (set.idle <= kMostIdleCalls) {
      kept.push_back(std::move(set));
    } else {
      known_.erase(set.points);
    }
  }
  sets_ = std::move(kept);
  has_lists_ = false;
}

double SubtourSets::Scale() const {
  double scale = 0;
  for (const Set& set : sets_) {
    scale += set.multiplier *
             (set.constant + static_cast<double>(set.subtracted.size() + set.within.size()));
  }
  return scale;
}

}  // namespace traverse
