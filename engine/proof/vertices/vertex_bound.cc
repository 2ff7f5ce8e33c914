#include "engine/proof/vertices/vertex_bound.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/base/at.h"
#include "engine/model/point.h"
#include "engine/proof/vertices/set_finder.h"

namespace traverse {
namespace {

// Places of an end to begin with, and splits after each round: where what a place may be wrong by,
// its width, as often as it is visited, is that share of a mean move.
constexpr size_t kFirstPlaces = 5;
constexpr size_t kFirstPlacesOfMany = 3;
constexpr size_t kManyEnds = 1000;
constexpr double kWidthWorthSplitting = 0.03;

// Nothing is split where there are so many moves, for each point of the plan or together: each
// takes some 240 bytes.
constexpr size_t kMostMovesOfPoint = 25;
constexpr size_t kMostMoves = 150'000;

// Beyond these, steps take too long, and a search takes more memory than a layer may: some 28 KB
// for each end, half of that where there are many ends.
constexpr size_t kMostEnds = 3500;

// Of many ends, with more points on average: what is measured at first would take too long at one
// go.
constexpr size_t kMostPointsOfEach = 25;

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
constexpr int kStepsBetweenSets = 20;
constexpr double kViolation = 0.1;

// After each round, moves are known that were not.
constexpr int kStepsOfRound = 60;

// A bound below that share of the target is far from it.
constexpr double kFarFrom = 0.8;

}  // namespace

bool VertexBound::Fits(const EndGraph& graph) {
  size_t points = 0;
  size_t most = 0;  // of an end
  for (const PathEnd& end : graph.ends) {
    points += end.points.size();
    most = std::max(most, end.points.size());
  }
  const size_t ends = graph.ends.size();
  return most > 1 && ends <= kMostEnds && (ends <= kManyEnds || points <= kMostPointsOfEach * ends);
}

VertexBound::VertexBound(const LayerProblem& problem, const TreeBound& tree)
    : graph_(tree.graph()),
      cost_(problem.cost),
      start_(problem.start),
      finish_(problem.finish),
      moves_(graph_, cost_, graph_.ends.size() > kManyEnds ? kFirstPlacesOfMany : kFirstPlaces),
      near_(moves_),
      sets_(moves_),
      multipliers_(At(moves_.point_count())),
      best_multipliers_(multipliers_),
      direction_(multipliers_),
      chosen_(graph_.ends.size()) {
  assert(Fits(graph_));
  for (const PathEnd& end : graph_.ends) points_of_plan_ += end.points.size();
  const size_t points = multipliers_.point.size();
  average_.points.resize(points);
  for (size_t v = 0; v < points; ++v) {
    multipliers_.point[v] = tree.multipliers()[At(moves_.end_of(static_cast<int>(v)))];
  }
  FindCostsOfFirstAndLast();
  AddPairs(tree);
}

void VertexBound::FindCostsOfFirstAndLast() {
  start_costs_.assign(At(moves_.point_count()), kFar);
  finish_costs_.assign(At(moves_.point_count()), kFar);
  const auto fill = [&](const std::vector<int>& ends, uint8_t role, std::vector<double>& costs,
                        const std::optional<Point>& place) {
    for (const int end : ends) {
      if ((graph_.ends[At(end)].roles & role) == 0) continue;
      for (int p = moves_.first(end); p < moves_.first(end + 1); ++p) {
        double least = place ? kFar : 0;
        for (const Point& point : moves_.places().points(p)) {
          if (place) least = std::min(least, Distance(*place, point));
        }
        costs[At(p)] = place ? cost_.OfLength(least) : 0;
      }
    }
  };
  fill(graph_.first, PathEnd::kEnter, start_costs_, start_);
  fill(graph_.last, PathEnd::kLeave, finish_costs_, finish_);
}

// The pairs that are nearest by the tree's multipliers.
void VertexBound::AddPairs(const TreeBound& tree) {
  std::vector<std::pair<double, size_t>> sorted;
  const std::vector<double>& multipliers = tree.multipliers();
  for (size_t i = 0; i < tree.pairs().size(); ++i) {
    const TreeBound::Pair& pair = tree.pairs()[i];
    sorted.emplace_back(pair.cost - multipliers[At(pair.ends[0])] - multipliers[At(pair.ends[1])],
                        i);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<size_t> known(graph_.ends.size(), 0);
  joined_.Reset(moves_.side_count());
  for (const auto& [cost, i] : sorted) {
    const TreeBound::Pair& pair = tree.pairs()[i];
    const int base = moves_.first_side(pair.junction);
    size_t& a = known[At(pair.ends[0])];
    size_t& b = known[At(pair.ends[1])];
    const bool joins = joined_.Join(base + pair.sides[0], base + pair.sides[1]);
    if (!joins && a >= kNeighbors && b >= kNeighbors) continue;
    ++a;
    ++b;
    moves_.AddPair(pair.junction, {pair.ends[0], pair.sides[0], 0},
                   {pair.ends[1], pair.sides[1], 0});
  }
  near_.AddNew();
  average_.moves.resize(moves_.moves().size());
}

// Splits the places that solutions visit. Multipliers, and so the bound, stay as they are.
void VertexBound::Refine() {
  if (moves_.moves().size() > std::min(kMostMoves, kMostMovesOfPoint * points_of_plan_)) return;
  const double least = kWidthWorthSplitting * mean_move_;
  std::vector<char> marked(average_.points.size());
  for (size_t v = 0; v < marked.size(); ++v) {
    marked[v] = average_.points[v] * moves_.places().width(static_cast<int>(v)) > least ? 1 : 0;
  }
  std::vector<size_t> parents;
  const std::vector<int> became = moves_.Split(marked, parents);
  const auto parts = [&](size_t v) { return became[v + 1] - became[v]; };
  const auto spread = [&](std::vector<double>& values, bool divide) {
    std::vector<double> split;
    for (size_t v = 0; v < marked.size(); ++v) {
      split.insert(split.end(), At(parts(v)), divide ? values[v] / parts(v) : values[v]);
    }
    values = std::move(split);
  };
  for (auto* it : {&multipliers_, &best_multipliers_}) {
    for (auto* values : {&it->point, &it->start, &it->finish}) spread(*values, false);
  }
  for (auto* values :
       {&direction_.point, &direction_.start, &direction_.finish, &average_.points}) {
    spread(*values, true);
  }
  std::vector<double> times(average_.moves.size());
  for (const size_t parent : parents) ++times[parent];
  std::vector<double> of_moves;
  for (const size_t parent : parents) {
    of_moves.push_back(average_.moves[parent] / times[parent]);
  }
  average_.moves = std::move(of_moves);
  near_.Split(became);
  sets_.Split(became);
  FindCostsOfFirstAndLast();
}

// Puts the last solution into the averages. What a point has of moves beyond those that choosing it
// allows is the direction of its multipliers.
void VertexBound::Average() {
  const double weight = std::max(kWeight, 1.0 / (steps_ + 1));
  for (auto* values : {&average_.moves, &average_.points, &direction_.point, &direction_.start,
                       &direction_.finish}) {
    for (double& value : *values) value *= 1 - weight;
  }
  taken_.clear();
  for (const Candidate& candidate : tree_) {
    const size_t move = CheapestOf(candidate.group);
    taken_.push_back({candidate.group, move});
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
  near_.Take(chosen_, weight);
  for (const SubtourSets::Taken& it : taken_) {
    near_.TakeMove(it.group, moves_.moves()[it.move], weight);
  }
  sets_.Take(taken_, chosen_, weight);
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
  double square = sets_.SquareOfDirection() + near_.SquareOfDirection();
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
  near_.Step(length);
  sets_.Step(length);
}

void VertexBound::Ascend(double target, Budget& budget) {
  double best_value = -kFar;
  int without_gain = 0;
  best_multipliers_ = multipliers_;
  near_.Keep();
  sets_.Keep();
  const auto go_back = [&] {
    multipliers_ = best_multipliers_;
    near_.GoBack();
    sets_.GoBack();
  };
  for (int step = 0; step < kStepsOfRound && !Ended(budget, work_of_evaluation_); ++step) {
    work_ += WorkOfStep();
    double value = EvaluateNear();
    if (value > best_value) {
      best_value = value;
      best_multipliers_ = multipliers_;
      near_.Keep();
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

// An evaluation, and what is made of its solution.
double VertexBound::WorkOfStep() const {
  return static_cast<double>(3 * moves_.moves().size() + 16 * moves_.groups().size());
}

double VertexBound::Search(double target, const Limits& limits, Budget& budget) {
  most_work_ = limits.work;
  mean_move_ = target / static_cast<double>(graph_.ends.size());
  double bound = std::max(0.0, EvaluateAll(budget));
  for (int round = 0; round < limits.rounds && bound < target; ++round) {
    const bool is_far = bound < kFarFrom * target;
    most_work_ = is_far ? std::max(limits.work, limits.work_while_far) : limits.work;
    if (Ended(budget, work_of_evaluation_ + WorkOfStep())) break;
    if (rounds_++ > 0) Refine();
    Ascend(target, budget);
    bound = std::max(bound, EvaluateAll(budget));
  }
  return bound;
}

}  // namespace traverse
