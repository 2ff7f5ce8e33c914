#include "engine/cost/entry_choice.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace traverse {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// From this many pairs of entries on, a tree is faster than a scan of all. Measured: a length costs
// 1.6 ns in a scan, a time 6.5 ns.
constexpr size_t kPairsForTreeOfLengths = 1 << 18;
constexpr size_t kPairsForTreeOfTimes = 1 << 12;

// Entries in a leaf of the tree.
constexpr int kTreeLeafSize = 8;

// The work of choosing the best predecessor of an entry, without the costs.
constexpr size_t kStepsOfEntry = 8;

// What a move with walls takes, as Rest counts steps.
constexpr size_t kStepsOfWalls = 512;

// totals[i] = best[i] + cost(exits[i] -> to). For lengths the loop has no branch, so that the
// compiler uses vector instructions.
void FillTotals(const TravelCost& cost, absl::Span<const Point> exits, Point to, const double* best,
                double* totals) {
  if (cost.is_length()) {
    for (size_t i = 0; i < exits.size(); ++i) totals[i] = best[i] + Distance(exits[i], to);
  } else {
    for (size_t i = 0; i < exits.size(); ++i) totals[i] = best[i] + cost(exits[i], to);
  }
}

}  // namespace

double EntryChoice::Choose(Point from, absl::Span<const int> paths, const std::optional<Point>& to,
                           absl::Span<int> entries) {
  assert(entries.size() == paths.size());
  if (paths.empty()) return to ? cost_(from, *to) : 0;
  parent_begin_.assign(paths.size() + 1, 0);
  for (size_t k = 1; k < paths.size(); ++k) {
    rest_(4);
    parent_begin_[k + 1] = parent_begin_[k] + static_cast<size_t>(table_->count(paths[k]));
  }
  parents_.resize(parent_begin_.back());

  EnterFirst(from, paths[0]);
  for (size_t k = 1; k < paths.size(); ++k) {
    Advance(paths[k - 1], paths[k], parents_.data() + parent_begin_[k]);
  }
  if (to) {
    const int first = table_->first(paths.back());
    for (size_t i = 0; i < best_.size(); ++i) {
      rest_(cost_.has_walls() ? kStepsOfWalls : 1);
      best_[i] += cost_(table_->exit(first + static_cast<int>(i)), *to);
    }
  }

  const auto least = std::min_element(best_.begin(), best_.end());
  int chosen = static_cast<int>(least - best_.begin());
  for (size_t k = paths.size(); k-- > 0;) {
    rest_(4);
    entries[k] = table_->first(paths[k]) + chosen;
    if (k > 0) chosen = parents_[parent_begin_[k] + static_cast<size_t>(chosen)];
  }
  return *least;
}

void EntryChoice::EnterFirst(Point from, int path) {
  const int first = table_->first(path);
  best_.resize(static_cast<size_t>(table_->count(path)));
  for (size_t j = 0; j < best_.size(); ++j) {
    rest_(cost_.has_walls() ? kStepsOfWalls : 1);
    best_[j] = cost_(from, table_->enter(first + static_cast<int>(j)));
  }
}

void EntryChoice::Advance(int from_path, int to_path, int* parent) {
  next_.resize(static_cast<size_t>(table_->count(to_path)));
  if (cost_.has_walls()) {
    AdvanceByBounds(from_path, to_path, parent);
    std::swap(best_, next_);
    return;
  }
  const size_t limit = cost_.is_length() ? kPairsForTreeOfLengths : kPairsForTreeOfTimes;
  if (best_.size() * next_.size() < limit) {
    AdvanceByScan(from_path, to_path, parent);
  } else {
    AdvanceByTree(from_path, to_path, parent);
  }
  std::swap(best_, next_);
}

void EntryChoice::AdvanceByScan(int from_path, int to_path, int* parent) {
  const absl::Span<const Point> exits = table_->exits(from_path);
  const absl::Span<const Point> enters = table_->enters(to_path);
  totals_.resize(exits.size());
  for (size_t j = 0; j < enters.size(); ++j) {
    rest_(kStepsOfEntry + exits.size());
    FillTotals(cost_, exits, enters[j], best_.data(), totals_.data());
    size_t least = 0;
    for (size_t i = 1; i < totals_.size(); ++i) {
      if (totals_[i] < totals_[least]) least = i;
    }
    next_[j] = totals_[least];
    parent[j] = static_cast<int>(least);
  }
}

// The part of walls is expensive to compute: only for moves that might be the best without them.
// Neighboring entries tend to have the same parent, so each search begins with that.
void EntryChoice::AdvanceByBounds(int from_path, int to_path, int* parent) {
  const absl::Span<const Point> exits = table_->exits(from_path);
  const absl::Span<const Point> enters = table_->enters(to_path);
  size_t guess = 0;
  for (size_t j = 0; j < enters.size(); ++j) {
    double least = best_[guess] + cost_(exits[guess], enters[j]);
    for (size_t i = 0; i < exits.size() && rest_(); ++i) {
      if (best_[i] >= least || best_[i] + cost_.Base(exits[i], enters[j]) >= least) continue;
      rest_(kStepsOfWalls);
      const double total = best_[i] + cost_(exits[i], enters[j]);
      if (total >= least) continue;
      least = total;
      guess = i;
    }
    next_[j] = least;
    parent[j] = static_cast<int>(guess);
  }
}

// Neighboring entries tend to have the same parent, so each search begins with the parent of the
// one before: the bounds then cut most of the tree off at once.
void EntryChoice::AdvanceByTree(int from_path, int to_path, int* parent) {
  tree_.clear();
  BuildTree(from_path, 0, static_cast<int>(best_.size()));
  const int from = table_->first(from_path);
  const int to = table_->first(to_path);
  int guess = 0;
  for (size_t j = 0; j < next_.size(); ++j) {
    const Point enter = table_->enter(to + static_cast<int>(j));
    const auto total = [&](int i) {
      return best_[static_cast<size_t>(i)] + cost_(table_->exit(from + i), enter);
    };
    double least = total(guess);
    for (size_t t = 0; t < tree_.size() && rest_(2);) {
      const TreeNode& node = tree_[t];
      if (node.best + cost_.OfLength(node.box.DistanceTo(enter)) >= least) {
        t = static_cast<size_t>(node.skip);
        continue;
      }
      ++t;
      if (node.end - node.first > kTreeLeafSize) continue;
      for (int i = node.first; i < node.end; ++i) {
        if (const double value = total(i); value < least) {
          least = value;
          guess = i;
        }
      }
    }
    next_[j] = least;
    parent[j] = guess;
  }
}

// The vertices of a contour come in the order of their places on it, so halves of a range are
// compact.
int EntryChoice::BuildTree(int path, int first, int end) {
  rest_(2 * kTreeLeafSize);
  const size_t index = tree_.size();
  tree_.push_back(TreeNode{{}, kInfinity, first, end, 0});
  TreeNode node = tree_[index];
  if (end - first > kTreeLeafSize) {
    const int middle = first + (end - first) / 2;
    for (const int child : {BuildTree(path, first, middle), BuildTree(path, middle, end)}) {
      node.box.Add(tree_[static_cast<size_t>(child)].box);
      node.best = std::min(node.best, tree_[static_cast<size_t>(child)].best);
    }
  } else {
    for (int i = first; i < end; ++i) {
      node.box.Add(table_->exit(table_->first(path) + i));
      node.best = std::min(node.best, best_[static_cast<size_t>(i)]);
    }
  }
  node.skip = static_cast<int>(tree_.size());
  tree_[index] = node;
  return static_cast<int>(index);
}

}  // namespace traverse
