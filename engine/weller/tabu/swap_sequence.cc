#include "engine/weller/tabu/swap_sequence.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>

namespace traverse {
namespace {

// Of a path with more entries than this, a swap tries two: those nearest to the new neighbors.
constexpr int kTryAllEntries = 4;

}  // namespace

SwapSequence::SwapSequence(const LayerProblem& problem, const LinkRules& rules, Budget* budget)
    : problem_(problem),
      table_(*problem.plan, budget),
      links_(problem, table_, rules),
      rest_(budget),
      choice_(table_, TravelCost(problem), budget),
      tree_(*problem.plan, budget) {
  Load(GivenRoute(*problem.plan, budget));
}

void SwapSequence::Load(const Route& route) {
  std::vector<int> paths;
  entries_.clear();
  for (const Visit& visit : route) {
    rest_(4);
    paths.push_back(visit.path);
    entries_.push_back(table_.EntryOf(visit));
  }
  tree_.Load(paths);
  ComputeCost();
}

Route SwapSequence::Unload() const {
  Route route;
  route.reserve(entries_.size());
  for (const int entry : entries_) {
    rest_(4);
    route.push_back(table_.VisitOf(entry));
  }
  return route;
}

void SwapSequence::ComputeCost() {
  cost_ = 0;
  for (int k = 0; k <= static_cast<int>(entries_.size()); ++k) {
    rest_(8);
    cost_ += links_(EntryBefore(k), EntryAt(k));
  }
}

int SwapSequence::PenalizedLinks() const {
  int count = 0;
  for (int k = 0; k <= static_cast<int>(entries_.size()); ++k) {
    rest_(8);
    count += links_.Penalized(EntryBefore(k), EntryAt(k));
  }
  return count;
}

int SwapSequence::NearestEntry(int path, std::optional<Point> to) const {
  int nearest = table_.first(path);
  if (!to || !rest_(static_cast<size_t>(table_.count(path)))) return nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int entry = table_.first(path); entry < table_.first(path + 1); ++entry) {
    const Point enter = table_.enter(entry);
    const double dx = enter.x - to->x;
    const double dy = enter.y - to->y;
    if (dx * dx + dy * dy >= least) continue;
    least = dx * dx + dy * dy;
    nearest = entry;
  }
  return nearest;
}

// Calls `function(first, last)` for the ends that `node` may have between the entries `before` and
// `after`: for a path each entry worth trying, twice, for other nodes their present ends.
template <typename Function>
void SwapSequence::ForEnds(int node, int before, int after, const Function& function) const {
  const int path = tree_.path_of(node);
  if (path < 0) {
    function(first_entry(node), last_entry(node));
    return;
  }
  if (table_.count(path) <= kTryAllEntries) {
    for (int e = table_.first(path); e < table_.first(path + 1); ++e) function(e, e);
    return;
  }
  const int from =
      NearestEntry(path, before == links_.start() ? problem_.start : table_.exit(before));
  function(from, from);
  const int to = NearestEntry(
      path, after == links_.finish() ? problem_.finish : std::optional(table_.enter(after)));
  function(to, to);
}

SwapSequence::Placed SwapSequence::BestBetween(int before, int node, int after) const {
  Placed best{-1, std::numeric_limits<double>::infinity()};
  const bool is_path = tree_.path_of(node) >= 0;
  ForEnds(node, before, after, [&](int first, int last) {
    const double cost = links_(before, first) + links_(last, after);
    if (cost < best.cost) best = {is_path ? first : -1, cost};
  });
  return best;
}

void SwapSequence::FillPlacedCosts(absl::Span<const int> nodes, int before, int after,
                                   absl::Span<double> placed) const {
  const double* from = links_.From(before);
  const double* to = links_.To(after);
  for (size_t k = 0; k < nodes.size(); ++k) {
    const int path = tree_.path_of(nodes[k]);
    if (from == nullptr || path < 0 || table_.count(path) > kTryAllEntries) {
      placed[k] = PlacedCost(nodes[k], before, after);
      continue;
    }
    const int first = table_.first(path);
    placed[k] = from[first] + to[first];
    for (int entry = first + 1; entry < table_.first(path + 1); ++entry) {
      placed[k] = std::min(placed[k], from[entry] + to[entry]);
    }
  }
}

// The cost of the moves before -> y -> x -> after with the best entries, for two paths with few of
// them; unset for others.
std::optional<double> SwapSequence::NeighborCost(int x, int y, int before, int after) const {
  const double* to_y = links_.From(before);
  const double* from_x = links_.To(after);
  const int x_path = tree_.path_of(x);
  const int y_path = tree_.path_of(y);
  if (to_y == nullptr || x_path < 0 || y_path < 0 || table_.count(x_path) > kTryAllEntries ||
      table_.count(y_path) > kTryAllEntries) {
    return std::nullopt;
  }
  double best = std::numeric_limits<double>::infinity();
  for (int y_entry = table_.first(y_path); y_entry < table_.first(y_path + 1); ++y_entry) {
    const double* from_y = links_.From(y_entry);
    for (int x_entry = table_.first(x_path); x_entry < table_.first(x_path + 1); ++x_entry) {
      best = std::min(best, to_y[y_entry] + from_y[x_entry] + from_x[x_entry]);
    }
  }
  return best;
}

double SwapSequence::NeighborDelta(int node, int i) const {
  const int x = tree_.child_at(node, i);
  const int y = tree_.child_at(node, i + 1);
  const auto cost = NeighborCost(x, y, entry_before(x), entry_after(y));
  if (!cost) return Evaluate(node, i, i + 1).delta;
  return *cost - links_(entry_before(x), first_entry(x)) - links_(last_entry(x), first_entry(y)) -
         links_(last_entry(y), entry_after(y));
}

// x is followed by y at once.
void SwapSequence::EvaluateNeighbors(int x, int y, SwapMove& move) const {
  const int before = entry_before(x);
  const int after = entry_after(y);
  const bool x_is_path = tree_.path_of(x) >= 0;
  const bool y_is_path = tree_.path_of(y) >= 0;
  double best = std::numeric_limits<double>::infinity();
  ForEnds(y, before, first_entry(x), [&](int y_first, int y_last) {
    const double to_y = links_(before, y_first);
    ForEnds(x, y_last, after, [&](int x_first, int x_last) {
      const double cost = to_y + links_(y_last, x_first) + links_(x_last, after);
      if (cost >= best) return;
      best = cost;
      move.entry_i = x_is_path ? x_first : -1;
      move.entry_j = y_is_path ? y_first : -1;
    });
  });
  move.delta = best - links_(before, first_entry(x)) - links_(last_entry(x), first_entry(y)) -
               links_(last_entry(y), after);
}

void SwapSequence::EvaluateApart(int x, int y, SwapMove& move) const {
  const Placed new_y = BestBetween(entry_before(x), y, entry_after(x));
  const Placed new_x = BestBetween(entry_before(y), x, entry_after(y));
  move.entry_i = new_x.entry;
  move.entry_j = new_y.entry;
  move.delta = new_x.cost + new_y.cost - PresentCost(x) - PresentCost(y);
}

SwapMove SwapSequence::Evaluate(int node, int i, int j) const {
  assert(0 <= i && i < j && j < tree_.child_count(node));
  SwapMove move;
  move.node = node;
  move.i = i;
  move.j = j;
  const int x = tree_.child_at(node, i);
  const int y = tree_.child_at(node, j);
  if (tree_.end(x) == tree_.begin(y)) {
    EvaluateNeighbors(x, y, move);
  } else {
    EvaluateApart(x, y, move);
  }
  move.violations = tree_.ViolationDelta(node, i, j);
  return move;
}

std::optional<SwapMove> SwapSequence::EvaluateReentry(int leaf) const {
  const int path = tree_.path_of(leaf);
  if (table_.count(path) < 2) return std::nullopt;
  const int present = first_entry(leaf);
  const int before = entry_before(leaf);
  const int after = entry_after(leaf);
  SwapMove move;
  move.node = leaf;
  double best = std::numeric_limits<double>::infinity();
  for (int entry = table_.first(path); entry < table_.first(path + 1); ++entry) {
    const double cost = links_(before, entry) + links_(entry, after);
    if (entry == present || cost >= best) continue;
    best = cost;
    move.entry_i = entry;
  }
  move.delta = best - PresentCost(leaf);
  return move;
}

void SwapSequence::Apply(const SwapMove& move) {
  if (move.i == move.j) {
    entries_[static_cast<size_t>(tree_.begin(move.node))] = move.entry_i;
    cost_ += move.delta;
    return;
  }
  const int x = tree_.child_at(move.node, move.i);
  const int y = tree_.child_at(move.node, move.j);
  const int x_size = tree_.end(x) - tree_.begin(x);
  const int y_size = tree_.end(y) - tree_.begin(y);
  const auto begin = entries_.begin() + tree_.begin(x);
  const auto end = entries_.begin() + tree_.end(y);
  if (x_size == y_size) {
    std::swap_ranges(begin, begin + x_size, end - y_size);
  } else {
    // x m y becomes y m x: turned as a whole, then each part back.
    std::reverse(begin, end);
    std::reverse(begin, begin + y_size);
    std::reverse(begin + y_size, end - x_size);
    std::reverse(end - x_size, end);
  }
  if (move.entry_i >= 0) *(end - 1) = move.entry_i;
  if (move.entry_j >= 0) *begin = move.entry_j;
  tree_.Swap(move.node, move.i, move.j);
  cost_ += move.delta;
}

void SwapSequence::ChooseEntries() {
  scratch_.clear();
  for (const int entry : entries_) {
    rest_(4);
    scratch_.push_back(table_.path_of(entry));
  }
  choice_.Choose(problem_.start, scratch_, problem_.finish, absl::MakeSpan(entries_));
  ComputeCost();
}

void SwapSequence::Shuffle(Rng& rng, bool best_entries) {
  tree_.Shuffle(rng);
  const std::vector<int> paths = tree_.Paths();
  for (size_t k = 0; k < paths.size(); ++k) {
    rest_(4);
    entries_[k] = table_.first(paths[k]);
    if (!best_entries) {
      entries_[k] += static_cast<int>(rng.Below(static_cast<uint32_t>(table_.count(paths[k]))));
    }
  }
  if (best_entries) {
    ChooseEntries();
  } else {
    ComputeCost();
  }
}

}  // namespace traverse
