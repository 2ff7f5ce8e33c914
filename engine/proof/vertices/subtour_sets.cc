#include "engine/proof/vertices/subtour_sets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/at.h"

namespace traverse {
namespace {

constexpr int kMostIdleCalls = 3;

}  // namespace

// Of the groups from `first_group` on.
void SubtourSets::FindMoves(Set& set, size_t first_group) const {
  struct OfEnd {
    int end = 0;
    const int* begin = nullptr;  // points
    const int* behind = nullptr;
    bool is_whole = false;
  };
  std::vector<OfEnd> ends;
  for (const int& point : set.points) {
    const int end = moves_.end_of(point);
    if (ends.empty() || ends.back().end != end) ends.push_back({end, &point, &point, false});
    ends.back().behind = &point + 1;
  }
  for (OfEnd& it : ends) it.is_whole = it.behind - it.begin == moves_.size(it.end);
  for (size_t i = 0; i < ends.size(); ++i) {
    for (size_t j = i + 1; j < ends.size(); ++j) {
      const NearMoves::Group* group = moves_.Find(ends[i].end, ends[j].end);
      if (group == nullptr || group < &moves_.groups()[0] + first_group) continue;
      const OfEnd& a = ends[i].is_whole ? ends[j] : ends[i];
      const OfEnd& b = ends[i].is_whole ? ends[i] : ends[j];
      if (a.is_whole) {
        set.groups.push_back(static_cast<size_t>(group - moves_.groups().data()));
        continue;
      }
      for (const int* p = a.begin; p != a.behind; ++p) {
        if (b.is_whole) {
          set.lines.push_back(moves_.LineOf(*group, *p));
          continue;
        }
        for (const int* q = b.begin; q != b.behind; ++q) {
          set.moves.push_back(moves_.IndexOf(*group, *p, *q));
        }
      }
    }
  }
}

// The moves that the average has within the set.
double SubtourSets::Within(const Set& set, const AverageSolution& average) const {
  double sum = 0;
  for (const size_t i : set.moves) sum += average.moves[i];
  for (const size_t g : set.groups) {
    const NearMoves::Group& group = moves_.groups()[g];
    for (size_t i = group.begin; i < group.end; ++i) sum += average.moves[i];
  }
  for (const size_t line : set.lines) {
    const auto after =
        std::upper_bound(moves_.groups().begin(), moves_.groups().end(), line,
                         [](size_t of, const NearMoves::Group& group) { return of < group.line; });
    const NearMoves::Group& group = *(after - 1);
    const size_t columns = At(moves_.size(group.ends[1]));
    const size_t rows = At(moves_.size(group.ends[0]));
    const size_t index = line - group.line;
    const bool is_row = index < rows;
    size_t i = group.begin + (is_row ? index * columns : index - rows);
    for (size_t k = 0; k < (is_row ? columns : rows); ++k, i += is_row ? 1 : columns) {
      sum += average.moves[i];
    }
  }
  return sum;
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
  if (whole == 0 && most_visited >= 0) {
    const int end = moves_.end_of(most_visited);
    std::erase_if(set.subtracted, [&](int point) { return moves_.end_of(point) == end; });
  }
  FindMoves(set, 0);
  set.direction = Within(set, average) - set.constant;
  for (const int point : set.subtracted) set.direction -= average.points[At(point)];
  if (set.direction < least) return false;
  known_.insert(set.points);
  sets_.push_back(std::move(set));
  groups_seen_ = moves_.groups().size();
  has_lists_ = false;
  return true;
}

void SubtourSets::AddNewMoves() {
  if (groups_seen_ == moves_.groups().size()) return;
  for (Set& set : sets_) FindMoves(set, groups_seen_);
  groups_seen_ = moves_.groups().size();
  has_lists_ = false;
}

void SubtourSets::Split(const std::vector<int>& became) {
  const auto parts = [&](const std::vector<int>& points) {
    std::vector<int> all;
    for (const int p : points) {
      for (int part = became[At(p)]; part < became[At(p) + 1]; ++part) all.push_back(part);
    }
    return all;
  };
  known_.clear();
  for (Set& set : sets_) {
    set.points = parts(set.points);
    set.subtracted = parts(set.subtracted);
    for (auto* list : {&set.groups, &set.lines, &set.moves}) list->clear();
    FindMoves(set, 0);
    known_.insert(set.points);
  }
  groups_seen_ = moves_.groups().size();
  has_lists_ = false;
}

double SubtourSets::Weigh(Penalties& penalties, std::vector<double>& paid_back) const {
  penalties.groups.assign(moves_.groups().size(), 0);
  penalties.lines.assign(moves_.line_count(), 0);
  penalties.moves.assign(moves_.moves().size(), 0);
  paid_back.assign(At(moves_.point_count()), 0);
  double sum = 0;
  for (const Set& set : sets_) {
    if (set.multiplier <= 0) continue;
    sum -= set.multiplier * set.constant;
    for (const size_t i : set.groups) penalties.groups[i] += set.multiplier;
    for (const size_t i : set.lines) penalties.lines[i] += set.multiplier;
    for (const size_t i : set.moves) penalties.moves[i] += set.multiplier;
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
  of_groups_ = ListsOf(
      moves_.groups().size(), [](const Set& set) -> const auto& { return set.groups; });
  of_lines_ = ListsOf(
      moves_.line_count(), [](const Set& set) -> const auto& { return set.lines; });
  of_moves_ = ListsOf(
      moves_.moves().size(), [](const Set& set) -> const auto& { return set.moves; });
  of_points_ = ListsOf(
      At(moves_.point_count()), [](const Set& set) -> const auto& { return set.subtracted; });
  has_lists_ = true;
}

void SubtourSets::Take(const std::vector<Taken>& moves, const std::vector<int>& points,
                       double weight) {
  if (!has_lists_) ListSets();
  for (Set& set : sets_) set.direction = (1 - weight) * set.direction - weight * set.constant;
  const auto add = [&](const Lists& lists, size_t of, double by) {
    for (uint32_t k = lists.begin[of]; k < lists.begin[of + 1]; ++k) {
      sets_[lists.sets[k]].direction += by;
    }
  };
  for (const Taken& it : moves) {
    const NearMoves::Group& group = moves_.groups()[it.group];
    add(of_groups_, it.group, weight);
    add(of_moves_, it.move, weight);
    for (const int point : moves_.moves()[it.move].points) {
      add(of_lines_, moves_.LineOf(group, point), weight);
    }
  }
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
             (set.constant + static_cast<double>(set.subtracted.size() + set.groups.size() +
                                                 set.lines.size() + set.moves.size()));
  }
  return scale;
}

}  // namespace traverse
