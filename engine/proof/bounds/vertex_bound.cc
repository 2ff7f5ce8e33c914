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

// Places of an end to begin with, and splits after each round: where what a place may be wrong by,
// its width, as often as it is visited, is that share of a mean move.
constexpr size_t kFirstPlaces = 5;
constexpr double kWidthWorthSplitting = 0.03;

// Nothing is split where there are so many moves for each point of the plan: each takes some 240
// bytes.
constexpr size_t kMostMovesOfPoint = 25;

// Beyond these, steps take too long, and a search takes more memory than a layer may: some 28 KB
// for each end.
constexpr size_t kMostEnds = 1000;

// Near ends of each end that the ascent looks at.
constexpr size_t kNeighbors = 8;

// Pairs that are not known are sorted out once there are so many for each end.
constexpr size_t kExtrasOfEnd = 16;

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

// What rounding can add up to in a sum over all moves, relative to the numbers summed up.
constexpr double kRounding = 1e-12;

}  // namespace

bool VertexBound::Fits(const EndGraph& graph) {
  return graph.ends.size() <= kMostEnds &&
         std::any_of(graph.ends.begin(), graph.ends.end(),
                     [](const PathEnd& end) { return end.points.size() > 1; });
}

VertexBound::VertexBound(const LayerProblem& problem, const TreeBound& tree)
    : graph_(tree.graph()),
      cost_(problem.cost),
      start_(problem.start),
      finish_(problem.finish),
      moves_(graph_, cost_, kFirstPlaces),
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

// What the multipliers of sets add to moves, and pay back. Returns the constant that is left.
double VertexBound::Weigh() {
  const double sum = sets_.Weigh(penalties_, paid_back_);
  near_.PayBack(paid_back_);
  for (size_t line = 0; line < penalties_.lines.size(); ++line) {
    penalties_.lines[line] += near_.multipliers()[line];
  }
  return sum;
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

double VertexBound::Least(size_t group) const {
  const NearMoves::Group& it = moves_.groups()[group];
  const int rows = moves_.size(it.ends[0]);
  const int columns = moves_.size(it.ends[1]);
  const double* of_row = multipliers_.point.data() + moves_.first(it.ends[0]);
  const double* of_column = multipliers_.point.data() + moves_.first(it.ends[1]);
  const double* row_penalty = &penalties_.lines[it.line];
  const double* column_penalty = row_penalty + rows;
  const NearMoves::Move* move = &moves_.moves()[it.begin];
  const double* penalty = &penalties_.moves[it.begin];
  double least = kFar;
  for (int i = 0; i < rows; ++i) {
    double least_of_row = kFar;
    for (int j = 0; j < columns; ++j) {
      least_of_row =
          std::min(least_of_row, (move++)->cost + *penalty++ + (column_penalty[j] - of_column[j]));
    }
    least = std::min(least, least_of_row + (row_penalty[i] - of_row[i]));
  }
  return least + penalties_.groups[group];
}

size_t VertexBound::CheapestOf(size_t group) const {
  const NearMoves::Group& it = moves_.groups()[group];
  const double* row_penalty = &penalties_.lines[it.line] - moves_.first(it.ends[0]);
  const double* column_penalty =
      &penalties_.lines[it.line] + moves_.size(it.ends[0]) - moves_.first(it.ends[1]);
  double least = kFar;
  size_t best = it.begin;
  for (size_t i = it.begin; i < it.end; ++i) {
    const NearMoves::Move& move = moves_.moves()[i];
    const double cost =
        (move.cost + penalties_.moves[i] +
         (column_penalty[move.points[1]] - multipliers_.point[At(move.points[1])])) +
        (row_penalty[move.points[0]] - multipliers_.point[At(move.points[0])]);
    if (cost >= least) continue;
    least = cost;
    best = i;
  }
  return best;
}

// Of two ends whose moves are not known, which have no penalties; anything from `most` on if it is
// not less.
double VertexBound::LeastOfUnknown(const Junction::Member& a, const Junction::Member& b,
                                   double most) const {
  double least = most;
  for (int p = moves_.first(a.end); p < moves_.first(a.end + 1); ++p) {
    for (int q = moves_.first(b.end); q < moves_.first(b.end + 1); ++q) {
      const double paid = multipliers_.point[At(p)] + multipliers_.point[At(q)];
      const Places& places = moves_.places();
      if (cost_.OfLength(places.box(p).DistanceTo(places.box(q))) - paid >= least) continue;
      least = std::min(least, moves_.Cost(p, q) - paid);
    }
  }
  return least;
}

// Kruskal's algorithm over the known moves, which connect the sides of each junction.
double VertexBound::EvaluateNear() {
  double sum = Weigh();
  sum += AddFirstAndLast() + ChoosePoints();
  candidates_.clear();
  for (size_t group = 0; group < moves_.groups().size(); ++group) {
    candidates_.push_back({Least(group), group});
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

// Kruskal's algorithm over the known moves and `extras`: fills tree_ and most_. Returns its sum.
double VertexBound::JoinKnown(const std::vector<Extra>& extras) {
  const size_t groups = moves_.groups().size();
  candidates_.clear();
  for (size_t group = 0; group < groups; ++group) {
    candidates_.push_back({Least(group), group});
  }
  for (size_t i = 0; i < extras.size(); ++i) candidates_.push_back({extras[i].cost, groups + i});
  std::sort(candidates_.begin(), candidates_.end());
  joined_.Reset(moves_.side_count());
  tree_.clear();
  most_.assign(graph_.junctions.size(), -kFar);
  std::vector<int> left(graph_.junctions.size());  // moves
  for (size_t j = 0; j < left.size(); ++j) left[j] = graph_.junctions[j].sides - 1;
  double sum = 0;
  for (const Candidate& candidate : candidates_) {
    int junction = 0;
    int sides[2];
    if (candidate.group < groups) {
      const NearMoves::Group& group = moves_.groups()[candidate.group];
      junction = group.junction;
      std::copy(group.sides, group.sides + 2, sides);
    } else {
      const Extra& extra = extras[candidate.group - groups];
      junction = extra.junction;
      for (int k = 0; k < 2; ++k) sides[k] = moves_.first_side(junction) + extra.members[k]->side;
    }
    if (!joined_.Join(sides[0], sides[1])) continue;
    sum += candidate.cost;
    tree_.push_back(candidate);
    most_[At(junction)] = std::max(most_[At(junction)], candidate.cost);
    --left[At(junction)];
  }
  for (size_t j = 0; j < left.size(); ++j) {
    if (left[j] > 0) most_[j] = kFar;
  }
  return sum;
}

// Keeps those that are in the tree.
void VertexBound::Keep(std::vector<Extra>& extras) const {
  const size_t groups = moves_.groups().size();
  std::vector<Extra> kept;
  for (const Candidate& it : tree_) {
    if (it.group >= groups) kept.push_back(extras[it.group - groups]);
  }
  extras = std::move(kept);
}

// The pairs of ends that are not known and may be cheaper than what a tree over the known moves
// has in their junction. False if the budget ended it.
bool VertexBound::FindExtras(std::vector<Extra>& extras, Budget& budget) {
  std::vector<double> paid(graph_.ends.size(), -kFar);  // at the point of the highest multiplier
  for (size_t v = 0; v < multipliers_.point.size(); ++v) {
    double& of_end = paid[At(moves_.end_of(static_cast<int>(v)))];
    of_end = std::max(of_end, multipliers_.point[v]);
  }
  size_t most_extras = kExtrasOfEnd * graph_.ends.size();
  for (size_t j = 0; j < graph_.junctions.size(); ++j) {
    const auto& members = graph_.junctions[j].members;
    for (size_t a = 0; a < members.size(); ++a) {
      if (budget.ExhaustedNow()) return false;
      const BoundingBox& box = graph_.ends[At(members[a].end)].box;
      for (size_t b = a + 1; b < members.size(); ++b) {
        const double of_both = paid[At(members[a].end)] + paid[At(members[b].end)];
        const double length = box.DistanceTo(graph_.ends[At(members[b].end)].box);
        if (cost_.OfLength(length) - of_both >= most_[j] || members[a].side == members[b].side ||
            (members[a].roles & OppositeRoles(members[b].roles)) == 0 ||
            moves_.Find(members[a].end, members[b].end) != nullptr) {
          continue;
        }
        const double cost = LeastOfUnknown(members[a], members[b], most_[j]);
        if (cost < most_[j])
          extras.push_back({cost, static_cast<int>(j), {&members[a], &members[b]}});
      }
      if (extras.size() <= most_extras) continue;
      JoinKnown(extras);
      Keep(extras);
    }
  }
  return true;
}

// The same over all moves, which is what bounds: 0 if the budget ended it. Makes the tree's moves
// known.
double VertexBound::EvaluateAll(Budget& budget) {
  double sum = Weigh();
  std::vector<Extra> extras;
  JoinKnown(extras);
  if (!FindExtras(extras, budget)) return 0;
  sum += AddFirstAndLast() + ChoosePoints();
  double scale = std::abs(sum) + sets_.Scale() + near_.Scale();
  sum += JoinKnown(extras);
  for (const Candidate& it : tree_) scale += std::abs(it.cost);
  Keep(extras);
  for (const Extra& it : extras) moves_.AddPair(it.junction, *it.members[0], *it.members[1]);
  average_.moves.resize(moves_.moves().size());
  near_.AddNew();
  sets_.AddNewMoves();
  for (const auto* values : {&multipliers_.point, &multipliers_.start, &multipliers_.finish}) {
    for (const double value : *values) scale += 2 * std::abs(value);
  }
  return sum - kRounding * scale;
}

// Splits the places that solutions visit. Multipliers, and so the bound, stay as they are.
void VertexBound::Refine() {
  if (moves_.moves().size() > kMostMovesOfPoint * points_of_plan_) return;
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
  for (int step = 0; step < kStepsOfRound && !budget.ExhaustedNow(); ++step) {
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

double VertexBound::Search(double target, int most_rounds, Budget& budget) {
  mean_move_ = target / static_cast<double>(graph_.ends.size());
  double bound = std::max(0.0, EvaluateAll(budget));
  for (int round = 0; round < most_rounds && !budget.was_exhausted() && bound < target; ++round) {
    if (rounds_++ > 0) Refine();
    Ascend(target, budget);
    bound = std::max(bound, EvaluateAll(budget));
  }
  return bound;
}

}  // namespace traverse
