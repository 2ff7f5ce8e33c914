#include "engine/search/entries/leaf_entries.h"

#include <algorithm>

#include "engine/geometry/bounding_box.h"

namespace traverse {

LeafEntries::LeafEntries(const LayerProblem& problem, Budget* budget) {
  if (problem.cost.kind == CostSpec::Kind::kTime) time_.emplace(problem.cost);
  Reserve(*problem.plan, budget);
  Rest rest(budget);
  BoundingBox box;
  box.Add(problem.start);
  for (const Path& path : problem.plan->paths) {
    rest(2 + path.points.size());
    box.Add(BoundingBox(path.points));
  }
  origin_ = box.center();
  for (const Path& path : problem.plan->paths) {
    rest(8);
    AddPath(path, rest);
  }
  AddEntry(problem.start, problem.start, 0);
  CloseLeaf(1, false);
  const Point finish = problem.finish.value_or(problem.start);
  AddEntry(finish, finish, 0);
  CloseLeaf(1, false);
}

// So that no array is moved while it grows: of a million entries that takes long.
void LeafEntries::Reserve(const Plan& plan, Budget* budget) {
  Rest rest(budget);
  size_t entries = 2;
  for (const Path& path : plan.paths) {
    rest(2);
    entries += path.kind == Path::Kind::kOpen ? 2 : path.points.size() + Index(kLanes);
  }
  enter_.reserve(entries);
  exit_.reserve(entries);
  visit_entry_.reserve(entries);
  x_.reserve(entries);
  y_.reserve(entries);
}

void LeafEntries::AddPath(const Path& path, Rest& rest) {
  const auto point = [&path](int i) { return path.points[Index(i)]; };
  if (path.kind == Path::Kind::kOpen) {
    AddEntry(point(0), point(1), 0);
    if (!path.one_way) AddEntry(point(1), point(0), 1);
    CloseLeaf(path.one_way ? 1 : 2, true);
    return;
  }
  const int count =
      static_cast<int>(path.allowed.empty() ? path.points.size() : path.allowed.size());
  for (int i = 0; i < count; ++i) {
    const int vertex = path.allowed.empty() ? i : path.allowed[Index(i)];
    AddEntry(point(vertex), point(vertex), vertex);
    rest(8);
  }
  CloseLeaf(count, false);
}

void LeafEntries::AddEntry(Point enter, Point exit, int visit_entry) {
  enter_.push_back(enter);
  exit_.push_back(exit);
  visit_entry_.push_back(visit_entry);
  x_.push_back(static_cast<float>(enter.x - origin_.x));
  y_.push_back(static_cast<float>(enter.y - origin_.y));
}

void LeafEntries::CloseLeaf(int count, bool open) {
  const int first = static_cast<int>(enter_.size()) - count;
  first_.push_back(first);
  count_.push_back(count);
  open_.push_back(open);
  if (open) {
    radius_.push_back(0);
    boxes_.emplace_back();
    return;
  }
  const BoundingBox box(absl::MakeConstSpan(enter_).subspan(Index(first)));
  boxes_.push_back({Relative(box.low()), Relative(box.high())});
  if (count == 1) {
    radius_.push_back(0);
    return;
  }
  radius_.push_back(std::max(box.width(), box.height()) / 2);
  for (int i = count; i % kLanes != 0; ++i)
    AddEntry(enter_.back(), exit_.back(), visit_entry_.back());
}

int LeafEntries::EntryOf(const Visit& visit) const {
  const auto begin = visit_entry_.begin() + first(visit.path);
  const auto end = begin + count(visit.path);
  return first(visit.path) + static_cast<int>(std::find(begin, end, visit.entry) - begin);
}

int LeafEntries::Best(int leaf, Point from, const Point* to, const TravelCost& cost) const {
  const int n = count(leaf);
  const int e = first(leaf);
  if (n == 1) return e;
  if (open(leaf)) {
    const auto total = [&](int entry) {
      return cost(from, enter(entry)) + (to != nullptr ? cost(exit(entry), *to) : 0);
    };
    return total(e + 1) < total(e) ? e + 1 : e;
  }
  if (cost.has_walls()) return BestAmongWalls(leaf, from, to, cost);
  return BestByLength(leaf, from, to);
}

// The best by length mostly is the best. If walls make it more expensive, looks at others to either
// side of it, so that soon most need no question.
int LeafEntries::BestAmongWalls(int leaf, Point from, const Point* to,
                                const TravelCost& cost) const {
  const auto base_behind = [&](int entry) {
    return to != nullptr ? cost.Base(exit(entry), *to) : 0;
  };
  const auto base = [&](int entry) { return cost.Base(from, enter(entry)) + base_behind(entry); };
  const auto behind = [&](int entry) { return to != nullptr ? cost(exit(entry), *to) : 0; };
  int best = BestByLength(leaf, from, to);
  double least = cost(from, enter(best)) + behind(best);
  if (least <= base(best)) return best;
  const auto try_entry = [&](int entry) {
    if (base(entry) >= least) return;
    const double before = cost(from, enter(entry));
    if (before + base_behind(entry) >= least) return;
    if (const double here = before + behind(entry); here < least) {
      least = here;
      best = entry;
    }
  };
  const int n = count(leaf);
  const int nearest = best - first(leaf);
  for (int i = 1; i < n; ++i) {
    const int step = i % 2 == 1 ? i / 2 + 1 : n - i / 2;
    try_entry(first(leaf) + (nearest + step) % n);
  }
  return best;
}

int LeafEntries::BestByLength(int leaf, Point from, const Point* to) const {
  const FloatEntries floats = Floats(leaf);
  const int n = count(leaf);
  const int e = first(leaf);
  const int best = to != nullptr ? BestBetween(floats, Relative(from), Relative(*to), time())
                                 : BestFrom(floats, Relative(from), time());
  return e + std::min(best, n - 1);
}

void LeafEntries::FillTails(int leaf, const Point* to, std::vector<float>& tails) const {
  tails.assign(Index(PaddedCount(leaf)), 0);
  if (to != nullptr) FillTail(Floats(leaf), Relative(*to), time(), tails.data());
}

int LeafEntries::BestWithTails(int leaf, Point from, const std::vector<float>& tails) const {
  const int best = BestWithTail(Floats(leaf), Relative(from), tails.data(), time());
  return first(leaf) + std::min(best, count(leaf) - 1);
}

void LeafEntries::FillPairBounds(int a, int b, Point from, const Point* to,
                                 const std::vector<float>& tails,
                                 std::vector<float>& bounds) const {
  bounds.resize(Index(PaddedCount(a)));
  const float least_tail = *std::min_element(tails.begin(), tails.end());
  if (to != nullptr) {
    const FloatPoint end = Relative(*to);
    FillBounds(Floats(a), Relative(from), BoxOf(b), least_tail, &end, time(), bounds.data());
  } else {
    FillBounds(Floats(a), Relative(from), BoxOf(b), least_tail, nullptr, time(), bounds.data());
  }
}

}  // namespace traverse
