#include "engine/proof/bounds/vertex_bound.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/at.h"
#include "engine/model/point.h"
#include "engine/proof/bounds/set_finder.h"

namespace traverse {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Beyond these, steps or the tree over all moves take too long, or gain little: contours of many
// points are next to each other at some of them.
constexpr size_t kMostEnds = 500;
constexpr size_t kMostPoints = 1500;
constexpr size_t kMostPointsOfEnd = 64;

// Near ends of each end that the ascent looks at.
constexpr size_t kNeighbors = 8;

// Of the ascent.
constexpr double kWeight = 0.06;  // of a solution in the average
constexpr double kStepLength = 0.15;
constexpr double kShorter = 0.5;
constexpr double kLonger = 1.1;
constexpr int kStepsWithoutGain = 15;

// Sets are looked for in the average after some steps, and then every so many.
constexpr int kStepsBeforeSets = 20;
constexpr int kStepsBetweenSets = 15;
constexpr double kViolation = 0.1;

// After each round, moves are known that were not.
constexpr int kStepsOfRound = 125;

// What rounding can add up to in a sum over all moves, relative to the numbers summed up.
constexpr double kRounding = 1e-12;

}  // namespace

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
      moves_(graph, cost_),
      sets_(moves_),
      multipliers_(At(moves_.point_count())),
      best_multipliers_(multipliers_),
      direction_(multipliers_),
      chosen_(graph.ends.size()) {
  assert(Fits(graph));
  const size_t points = multipliers_.point.size();
  average_.points.resize(points);
  for (size_t v = 0; v < points; ++v) {
    multipliers_.point[v] = multipliers[At(moves_.end_of(static_cast<int>(v)))];
  }
  start_costs_.assign(points, kFar);
  finish_costs_.assign(points, kFar);
  const auto fill = [&](const std::vector<int>& ends, uint8_t role, std::vector<double>& costs,
                        const std::optional<Point>& place) {
    for (const int end : ends) {
      const PathEnd& it = graph_.ends[At(end)];
      if ((it.roles & role) == 0) continue;
      for (size_t i = 0; i < it.points.size(); ++i) {
        costs[At(moves_.first(end)) + i] = place ? cost_.Base(*place, it.points[i]) : 0;
      }
    }
  };
  fill(graph_.first, PathEnd::kEnter, start_costs_, problem.start);
  fill(graph_.last, PathEnd::kLeave, finish_costs_, problem.finish);
}

// The cheapest moves from the start and to the finish.
double VertexBound::AddFirstAndLast() {
  const auto least = [&](const std::vector<double>& costs, const std::vector<double>& multipliers,
                         int& best) {
    double sum = kFar;
    for (size_t v = 0; v < costs.size(); ++v) {
      const double cost = costs[v] - multipliers_.point[v] + multipliers[v];
      if (cost >= sum) continue;
      sum = cost;
      best = static_cast<int>(v);
    }
    return sum;
  };
  return least(start_costs_, multipliers_.start, first_) +
         least(finish_costs_, multipliers_.finish, last_);
}

// What is paid back at the cheapest point of each end.
double VertexBound::ChoosePoints() {
  double sum = 0;
  for (size_t end = 0; end < graph_.ends.size(); ++end) {
    double least = kFar;
    const int behind = moves_.first(static_cast<int>(end) + 1);
    for (int v = moves_.first(static_cast<int>(end)); v < behind; ++v) {
      const size_t i = At(v);
      const double cost = graph_.ends[end].moves * multipliers_.point[i] - paid_back_[i] -
                          multipliers_.start[i] - multipliers_.finish[i];
      if (cost >= least) continue;
      least = cost;
      chosen_[end] = v;
    }
    sum += least;
  }
  return sum;
}

double VertexBound::Least(const NearMoves::Group& group) const {
  double least = kFar;
  for (size_t i = group.begin; i < group.end; ++i) {
    const NearMoves::Move& move = moves_.moves()[i];
    least = std::min(least, move.cost + penalties_[i] - multipliers_.point[At(move.points[0])] -
                                multipliers_.point[At(move.points[1])]);
  }
  return least;
}

size_t VertexBound::CheapestOf(const NearMoves::Group& group) const {
  double least = kFar;
  size_t best = group.begin;
  for (size_t i = group.begin; i < group.end; ++i) {
    const NearMoves::Move& move = moves_.moves()[i];
    const double cost = move.cost + penalties_[i] - multipliers_.point[At(move.points[0])] -
                        multipliers_.point[At(move.points[1])];
    if (cost >= least) continue;
    least = cost;
    best = i;
  }
  return best;
}

// Moves that are not known have no penalties.
VertexBound::AnyCandidate VertexBound::CheapestOfAny(int junction, const Junction::Member& a,
                                                     const Junction::Member& b) const {
  if (const NearMoves::Group* group = moves_.Find(a.end, b.end)) {
    return {Least(*group), junction, {&a, &b}};
  }
  const auto& from = graph_.ends[At(a.end)].points;
  const auto& to = graph_.ends[At(b.end)].points;
  const double* of_a = multipliers_.point.data() + moves_.first(a.end);
  const double* of_b = multipliers_.point.data() + moves_.first(b.end);
  double least = kFar;
  for (size_t i = 0; i < from.size(); ++i) {
    for (size_t j = 0; j < to.size(); ++j) {
      least = std::min(least, cost_.Base(from[i], to[j]) - of_a[i] - of_b[j]);
    }
  }
  return {least, junction, {&a, &b}};
}

// Kruskal's algorithm over the known moves, which connect the sides of each junction.
double VertexBound::EvaluateNear() {
  double sum = sets_.Weigh(penalties_, paid_back_);
  sum += AddFirstAndLast() + ChoosePoints();
  candidates_.clear();
  for (size_t group = 0; group < moves_.groups().size(); ++group) {
    candidates_.push_back({Least(moves_.groups()[group]), group});
  }
  std::sort(candidates_.begin(), candidates_.end());
  joined_.Reset(moves_.side_count());
  tree_.clear();
  for (const Candidate& candidate : candidates_) {
    const int* sides = moves_.groups()[candidate.group].sides;
    if (!joined_.Join(sides[0], sides[1])) continue;
    sum += candidate.cost;
    tree_.push_back(candidate);
  }
  return sum;
}

// False if the budget ended it.
bool VertexBound::ListAll(std::vector<AnyCandidate>& all, Budget& budget) {
  for (size_t j = 0; j < graph_.junctions.size(); ++j) {
    const auto& members = graph_.junctions[j].members;
    for (size_t a = 0; a < members.size(); ++a) {
      if (budget.ExhaustedNow()) return false;
      for (size_t b = a + 1; b < members.size(); ++b) {
        if (members[a].side == members[b].side) continue;
        if ((members[a].roles & OppositeRoles(members[b].roles)) == 0) continue;
        all.push_back(CheapestOfAny(static_cast<int>(j), members[a], members[b]));
      }
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
  return true;
}

// The same over all moves, which is what bounds: 0 if the budget ended it. Makes the tree's moves
// known, and at first those of the nearest of each end.
double VertexBound::EvaluateAll(Budget& budget) {
  double sum = sets_.Weigh(penalties_, paid_back_);
  std::vector<AnyCandidate> all;
  if (!ListAll(all, budget)) return 0;
  sum += AddFirstAndLast() + ChoosePoints();
  double scale = std::abs(sum) + sets_.Scale();
  joined_.Reset(moves_.side_count());
  const bool is_first = moves_.groups().empty();
  std::vector<AnyCandidate> tree;
  for (const AnyCandidate& it : all) {
    const int base = moves_.first_side(it.junction);
    if (!joined_.Join(base + it.members[0]->side, base + it.members[1]->side)) continue;
    sum += it.cost;
    scale += std::abs(it.cost);
    tree.push_back(it);
  }
  for (const AnyCandidate& it : tree) {
    moves_.AddPair(it.junction, *it.members[0], *it.members[1]);
  }
  if (is_first) {
    AddNearest(all, budget);
    for (const NearMoves::Group& group : moves_.groups()) {
      if (budget.Exhausted()) return 0;
      sets_.AddNear(group);
    }
  }
  average_.moves.resize(moves_.moves().size());
  sets_.AddNewMoves();
  for (const auto* values : {&multipliers_.point, &multipliers_.start, &multipliers_.finish}) {
    for (const double value : *values) scale += 2 * std::abs(value);
  }
  return sum - kRounding * scale;
}

// `candidates` are sorted by cost.
void VertexBound::AddNearest(const std::vector<AnyCandidate>& candidates, Budget& budget) {
  std::vector<size_t> known(graph_.ends.size(), 0);
  for (const AnyCandidate& it : candidates) {
    size_t& a = known[At(it.members[0]->end)];
    size_t& b = known[At(it.members[1]->end)];
    if (a >= kNeighbors && b >= kNeighbors) continue;
    if (budget.Exhausted()) return;
    ++a;
    ++b;
    moves_.AddPair(it.junction, *it.members[0], *it.members[1]);
  }
}

// Puts the last solution into the averages. What a point has of moves beyond those that choosing it
// allows is the direction of its multipliers.
void VertexBound::Average() {
  const double weight = std::max(kWeight, 1.0 / (steps_ + 1));
  for (auto* values : {&average_.moves, &average_.points, &direction_.point, &direction_.start,
                       &direction_.finish}) {
    for (double& value : *values) value *= 1 - weight;
  }
  tree_moves_.clear();
  for (const Candidate& candidate : tree_) {
    const size_t move = CheapestOf(moves_.groups()[candidate.group]);
    tree_moves_.push_back(move);
    average_.moves[move] += weight;
    for (const int point : moves_.moves()[move].points) direction_.point[At(point)] -= weight;
  }
  direction_.point[At(first_)] -= weight;
  direction_.point[At(last_)] -= weight;
  direction_.start[At(first_)] += weight;
  direction_.finish[At(last_)] += weight;
  for (size_t end = 0; end < chosen_.size(); ++end) {
    const size_t point = At(chosen_[end]);
    average_.points[point] += weight;
    direction_.point[point] += weight * graph_.ends[end].moves;
    direction_.start[point] -= weight;
    direction_.finish[point] -= weight;
  }
  sets_.Take(tree_moves_, chosen_, weight);
}

void VertexBound::Cut(Budget& budget) {
  bool found = false;
  SetFinder(moves_, average_)
      .Find(
          kViolation,
          [&](const std::vector<int>& points) {
            if (budget.Exhausted()) return false;
            const bool taken = sets_.Add(points, average_, kViolation);
            found = found || taken;
            return taken;
          },
          budget);
  if (found) factor_ = std::min(1.0, kLonger * factor_);
  sets_.DropIdle();
}

// Multipliers of inequalities are at least 0, and those that are 0 do not count where they would
// become less.
double VertexBound::SquareOfDirection() const {
  double square = sets_.SquareOfDirection();
  for (const double value : direction_.point) square += value * value;
  const auto add = [&](const std::vector<double>& direction, const std::vector<double>& values) {
    for (size_t v = 0; v < values.size(); ++v) {
      if (values[v] > 0 || direction[v] > 0) square += direction[v] * direction[v];
    }
  };
  add(direction_.start, multipliers_.start);
  add(direction_.finish, multipliers_.finish);
  return square;
}

void VertexBound::Step(double length) {
  const auto move = [&](std::vector<double>& values, const std::vector<double>& by, double least) {
    for (size_t v = 0; v < values.size(); ++v)
      values[v] = std::max(least, values[v] + length * by[v]);
  };
  move(multipliers_.point, direction_.point, -kFar);
  move(multipliers_.start, direction_.start, 0);
  move(multipliers_.finish, direction_.finish, 0);
  sets_.Step(length);
}

void VertexBound::Ascend(double target, Budget& budget) {
  double best_value = -kFar;
  int without_gain = 0;
  best_multipliers_ = multipliers_;
  sets_.Keep();
  const auto go_back = [&] {
    multipliers_ = best_multipliers_;
    sets_.GoBack();
  };
  for (int step = 0; step < kStepsOfRound && !budget.ExhaustedNow(); ++step) {
    double value = EvaluateNear();
    if (value > best_value) {
      best_value = value;
      best_multipliers_ = multipliers_;
      sets_.Keep();
      without_gain = 0;
    } else if (++without_gain == kStepsWithoutGain) {
      without_gain = 0;
      factor_ *= kShorter;
      go_back();
      value = EvaluateNear();
    }
    if (value >= target) break;
    Average();
    if (steps_ >= kStepsBeforeSets && steps_ % kStepsBetweenSets == 0) Cut(budget);
    ++steps_;
    const double square = SquareOfDirection();
    if (square == 0) break;
    Step(factor_ * kStepLength * (target - value) / square);
  }
  go_back();
}

double VertexBound::Search(double target, int most_rounds, Budget& budget) {
  double bound = std::max(0.0, EvaluateAll(budget));
  for (int round = 0; round < most_rounds && !budget.was_exhausted() && bound < target; ++round) {
    Ascend(target, budget);
    bound = std::max(bound, EvaluateAll(budget));
  }
  return bound;
}

}  // namespace traverse
