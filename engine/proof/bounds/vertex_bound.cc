#include "engine/proof/bounds/vertex_bound.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/model/point.h"

namespace traverse {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Beyond these, steps or the tree over all pairs take too long, or gain little: contours of many
// points are next to each other at some of them.
constexpr size_t kMostEnds = 500;
constexpr size_t kMostPoints = 1500;
constexpr size_t kMostPointsOfEnd = 64;
constexpr size_t kMostMoves = 60'000;  // between points of known pairs

// Near ends of each end that the ascent looks at.
constexpr size_t kNeighbors = 8;

// Of the ascent.
constexpr double kFirstFactor = 0.5;
constexpr double kDeflection = 0.95;  // share of the last direction that is kept
constexpr double kShorter = 0.6;
constexpr int kStepsWithoutGain = 12;

// After each round, pairs are known that were not.
constexpr int kRounds = 2;

// What rounding can add up to in a sum over all moves, relative to the numbers summed up.
constexpr double kRounding = 1e-12;

size_t At(int index) { return static_cast<size_t>(index); }

}  // namespace

void VertexBound::Values::Resize(size_t points, size_t of_pairs) {
  point.resize(points);
  start.resize(points);
  finish.resize(points);
  near.resize(of_pairs);
}

bool VertexBound::Fits(const EndGraph& graph) {
  size_t points = 0;
  bool has_choice = false;
  for (const PathEnd& end : graph.ends) {
    points += end.points.size();
    has_choice = has_choice || end.points.size() > 1;
    if (end.points.size() > kMostPointsOfEnd) return false;
  }
  return has_choice && graph.ends.size() <= kMostEnds && points <= kMostPoints;
}

VertexBound::VertexBound(const LayerProblem& problem, const EndGraph& graph,
                         const std::vector<double>& multipliers)
    : graph_(graph),
      cost_(problem),
      first_point_(1, 0),
      first_side_(1, 0),
      pairs_of_(graph.ends.size()),
      chosen_(graph.ends.size()) {
  assert(Fits(graph));
  for (const PathEnd& end : graph_.ends) {
    first_point_.push_back(first_point_.back() + end.points.size());
  }
  for (const Junction& junction : graph_.junctions) {
    first_side_.push_back(first_side_.back() + junction.sides);
  }
  const size_t points = first_point_.back();
  multipliers_.Resize(points, 0);
  for (size_t end = 0; end < graph_.ends.size(); ++end) {
    std::fill(multipliers_.point.begin() + static_cast<ptrdiff_t>(first_point_[end]),
              multipliers_.point.begin() + static_cast<ptrdiff_t>(first_point_[end + 1]),
              multipliers[end]);
  }
  start_costs_.assign(points, kFar);
  finish_costs_.assign(points, kFar);
  const auto fill = [&](const std::vector<int>& ends, uint8_t role, std::vector<double>& costs,
                        const std::optional<Point>& place) {
    for (const int end : ends) {
      const PathEnd& it = graph_.ends[At(end)];
      if ((it.roles & role) == 0) continue;
      for (size_t i = 0; i < it.points.size(); ++i) {
        costs[first_point_[At(end)] + i] = place ? cost_.Base(*place, it.points[i]) : 0;
      }
    }
  };
  fill(graph_.first, PathEnd::kEnter, start_costs_, problem.start);
  fill(graph_.last, PathEnd::kLeave, finish_costs_, problem.finish);
}

void VertexBound::AddPair(int junction, const Junction::Member& a, const Junction::Member& b) {
  const auto& known = pairs_of_[At(a.end)];
  if (std::any_of(known.begin(), known.end(), [&](const auto& it) { return it.first == b.end; })) {
    return;
  }
  Pair pair;
  pair.ends[0] = a.end;
  pair.ends[1] = b.end;
  pair.sides[0] = first_side_[At(junction)] + a.side;
  pair.sides[1] = first_side_[At(junction)] + b.side;
  for (const Point& from : graph_.ends[At(a.end)].points) {
    for (const Point& to : graph_.ends[At(b.end)].points)
      pair.costs.push_back(cost_.Base(from, to));
  }
  for (int k = 0; k < 2; ++k) {
    pair.multipliers[k] = multipliers_.near.size();
    multipliers_.near.resize(multipliers_.near.size() + Count(pair.ends[k]));
  }
  pairs_of_[At(a.end)].emplace_back(b.end, pairs_.size());
  pairs_of_[At(b.end)].emplace_back(a.end, pairs_.size());
  pairs_.push_back(std::move(pair));
}

// The cheapest moves from the start and to the finish.
double VertexBound::AddFirstAndLast() {
  const auto least = [&](const std::vector<double>& costs, const std::vector<double>& multipliers,
                         size_t& best) {
    double sum = kFar;
    for (size_t v = 0; v < costs.size(); ++v) {
      const double cost = costs[v] - multipliers_.point[v] + multipliers[v];
      if (cost >= sum) continue;
      sum = cost;
      best = v;
    }
    return sum;
  };
  return least(start_costs_, multipliers_.start, first_) +
         least(finish_costs_, multipliers_.finish, last_);
}

// What is paid back at the cheapest point of each end.
double VertexBound::ChoosePoints() {
  paid_back_.assign(multipliers_.point.size(), 0);
  for (const Pair& pair : pairs_) {
    for (int k = 0; k < 2; ++k) {
      double* paid = paid_back_.data() + first_point_[At(pair.ends[k])];
      const double* of_pair = multipliers_.near.data() + pair.multipliers[k];
      for (size_t i = 0; i < Count(pair.ends[k]); ++i) paid[i] += of_pair[i];
    }
  }
  double sum = 0;
  for (size_t end = 0; end < graph_.ends.size(); ++end) {
    double least = kFar;
    for (size_t v = first_point_[end]; v < first_point_[end + 1]; ++v) {
      const double cost = graph_.ends[end].moves * multipliers_.point[v] - paid_back_[v] -
                          multipliers_.start[v] - multipliers_.finish[v];
      if (cost >= least) continue;
      least = cost;
      chosen_[end] = v - first_point_[end];
    }
    sum += least;
  }
  return sum;
}

VertexBound::Candidate VertexBound::CheapestOf(size_t index) const {
  const Pair& pair = pairs_[index];
  const double* of_a = multipliers_.point.data() + first_point_[At(pair.ends[0])];
  const double* of_b = multipliers_.point.data() + first_point_[At(pair.ends[1])];
  const double* near_a = multipliers_.near.data() + pair.multipliers[0];
  const double* near_b = multipliers_.near.data() + pair.multipliers[1];
  const size_t count = Count(pair.ends[1]);
  Candidate best{kFar, index, {0, 0}};
  for (size_t i = 0; i < Count(pair.ends[0]); ++i) {
    const double* costs = pair.costs.data() + i * count;
    const double from = near_a[i] - of_a[i];
    for (size_t j = 0; j < count; ++j) {
      const double cost = costs[j] + from + near_b[j] - of_b[j];
      if (cost < best.cost) best = {cost, index, {i, j}};
    }
  }
  return best;
}

// Pairs that are not known have no multipliers of their own.
VertexBound::AnyCandidate VertexBound::CheapestOfAny(int junction, const Junction::Member& a,
                                                     const Junction::Member& b) const {
  AnyCandidate best{kFar, junction, {&a, &b}};
  for (const auto& [other, pair] : pairs_of_[At(a.end)]) {
    if (other == b.end) best.cost = CheapestOf(pair).cost;
  }
  if (best.cost < kFar) return best;
  const auto& from = graph_.ends[At(a.end)].points;
  const auto& to = graph_.ends[At(b.end)].points;
  const double* of_a = multipliers_.point.data() + first_point_[At(a.end)];
  const double* of_b = multipliers_.point.data() + first_point_[At(b.end)];
  for (size_t i = 0; i < from.size(); ++i) {
    for (size_t j = 0; j < to.size(); ++j) {
      best.cost = std::min(best.cost, cost_.Base(from[i], to[j]) - of_a[i] - of_b[j]);
    }
  }
  return best;
}

// Kruskal's algorithm over the known pairs, which connect the sides of each junction.
double VertexBound::EvaluateNear() {
  double sum = AddFirstAndLast() + ChoosePoints();
  candidates_.clear();
  for (size_t pair = 0; pair < pairs_.size(); ++pair) candidates_.push_back(CheapestOf(pair));
  std::sort(candidates_.begin(), candidates_.end());
  joined_.Reset(first_side_.back());
  moves_.clear();
  for (const Candidate& candidate : candidates_) {
    const Pair& pair = pairs_[candidate.pair];
    if (!joined_.Join(pair.sides[0], pair.sides[1])) continue;
    sum += candidate.cost;
    moves_.push_back(candidate);
  }
  return sum;
}

// The same over all pairs, which is what bounds: 0 if the budget ended it. Makes the tree's pairs
// known, and at first the nearest of each end.
double VertexBound::EvaluateAll(Budget& budget) {
  std::vector<AnyCandidate> all;
  for (size_t j = 0; j < graph_.junctions.size(); ++j) {
    const auto& members = graph_.junctions[j].members;
    for (size_t a = 0; a < members.size(); ++a) {
      if (budget.ExhaustedNow()) return 0;
      for (size_t b = a + 1; b < members.size(); ++b) {
        if (members[a].side == members[b].side) continue;
        if ((members[a].roles & OppositeRoles(members[b].roles)) == 0) continue;
        all.push_back(CheapestOfAny(static_cast<int>(j), members[a], members[b]));
      }
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
  double sum = AddFirstAndLast() + ChoosePoints();
  double scale = std::abs(sum);
  joined_.Reset(first_side_.back());
  const bool is_first = pairs_.empty();
  for (const AnyCandidate& it : all) {
    const int base = first_side_[At(it.junction)];
    if (!joined_.Join(base + it.members[0]->side, base + it.members[1]->side)) continue;
    sum += it.cost;
    scale += std::abs(it.cost);
    AddPair(it.junction, *it.members[0], *it.members[1]);
  }
  if (is_first) AddNearest(all);
  for (const auto* values :
       {&multipliers_.point, &multipliers_.start, &multipliers_.finish, &multipliers_.near}) {
    for (const double value : *values) scale += 2 * std::abs(value);
  }
  return sum - kRounding * scale;
}

// `candidates` are sorted by cost.
void VertexBound::AddNearest(std::vector<AnyCandidate>& candidates) {
  std::vector<size_t> known(graph_.ends.size(), 0);
  for (const AnyCandidate& it : candidates) {
    size_t& a = known[At(it.members[0]->end)];
    size_t& b = known[At(it.members[1]->end)];
    if (a >= kNeighbors && b >= kNeighbors) continue;
    ++a;
    ++b;
    AddPair(it.junction, *it.members[0], *it.members[1]);
  }
}

// Moves at each point beyond those that choosing it allows.
VertexBound::Values VertexBound::Subgradient() const {
  Values gradient;
  gradient.Resize(multipliers_.point.size(), multipliers_.near.size());
  for (const Candidate& move : moves_) {
    const Pair& pair = pairs_[move.pair];
    for (int k = 0; k < 2; ++k) {
      gradient.point[first_point_[At(pair.ends[k])] + move.points[k]] -= 1;
      gradient.near[pair.multipliers[k] + move.points[k]] += 1;
    }
  }
  gradient.point[first_] -= 1;
  gradient.point[last_] -= 1;
  gradient.start[first_] += 1;
  gradient.finish[last_] += 1;
  for (size_t end = 0; end < graph_.ends.size(); ++end) {
    const size_t v = first_point_[end] + chosen_[end];
    gradient.point[v] += graph_.ends[end].moves;
    gradient.start[v] -= 1;
    gradient.finish[v] -= 1;
  }
  for (const Pair& pair : pairs_) {
    for (int k = 0; k < 2; ++k) {
      gradient.near[pair.multipliers[k] + chosen_[At(pair.ends[k])]] -= 1;
    }
  }
  return gradient;
}

void VertexBound::Ascend(double target, int most_steps, Budget& budget) {
  Values direction;
  direction.Resize(multipliers_.point.size(), multipliers_.near.size());
  Values best = multipliers_;
  double best_value = -kFar;
  double factor = kFirstFactor;
  int without_gain = 0;
  for (int step = 0; step < most_steps && !budget.ExhaustedNow(); ++step) {
    double value = EvaluateNear();
    if (value > best_value) {
      best_value = value;
      best = multipliers_;
      without_gain = 0;
    } else if (++without_gain == kStepsWithoutGain) {
      without_gain = 0;
      factor *= kShorter;
      multipliers_ = best;
      value = EvaluateNear();
    }
    if (value >= target) break;
    const Values gradient = Subgradient();
    double square = 0;
    // Multipliers of inequalities are at least 0, and those that are 0 do not count where they
    // would become less.
    const auto turn = [&](std::vector<double>& to, const std::vector<double>& by,
                          const std::vector<double>* least_zero) {
      for (size_t i = 0; i < to.size(); ++i) {
        to[i] = kDeflection * to[i] + by[i];
        if (least_zero != nullptr && (*least_zero)[i] <= 0) to[i] = std::max(to[i], 0.0);
        square += to[i] * to[i];
      }
    };
    turn(direction.point, gradient.point, nullptr);
    turn(direction.start, gradient.start, &multipliers_.start);
    turn(direction.finish, gradient.finish, &multipliers_.finish);
    turn(direction.near, gradient.near, &multipliers_.near);
    if (square == 0) break;
    const double length = factor * (target - value) / square;
    const auto move = [length](std::vector<double>& values, const std::vector<double>& by,
                               bool at_least_zero) {
      for (size_t i = 0; i < values.size(); ++i) {
        values[i] += length * by[i];
        if (at_least_zero) values[i] = std::max(values[i], 0.0);
      }
    };
    move(multipliers_.point, direction.point, false);
    move(multipliers_.start, direction.start, true);
    move(multipliers_.finish, direction.finish, true);
    move(multipliers_.near, direction.near, true);
  }
  multipliers_ = std::move(best);
}

double VertexBound::Search(double target, int most_steps, Budget& budget) {
  double bound = std::max(0.0, EvaluateAll(budget));
  size_t moves = 0;
  for (const Pair& pair : pairs_) moves += pair.costs.size();
  if (moves > kMostMoves) return bound;
  for (int round = 0; round < kRounds && !budget.was_exhausted() && bound < target; ++round) {
    Ascend(target, most_steps / kRounds, budget);
    bound = std::max(bound, EvaluateAll(budget));
  }
  return bound;
}

}  // namespace traverse
