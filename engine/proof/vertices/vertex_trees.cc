// How VertexBound evaluates its multipliers: trees over the known moves, and over all.

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/at.h"
#include "engine/proof/vertices/vertex_bound.h"

namespace traverse {
namespace {

// Pairs that are not known are sorted out once there are so many for each end.
constexpr size_t kExtrasOfEnd = 16;

// What rounding can add up to in a sum over all moves, relative to the numbers summed up.
constexpr double kRounding = 1e-12;

}  // namespace

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
// has in their junction. False if the budget or the work ended it.
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
      if (Ended(budget, -work_of_evaluation_)) return false;
      work_ += static_cast<double>(members.size() - a);
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

// The same over all moves, which is what bounds: 0 if the budget or the work ended it. Makes the
// tree's moves known.
double VertexBound::EvaluateAll(Budget& budget) {
  const double work_before = work();
  work_ += WorkOfStep();
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
  work_of_evaluation_ = work() - work_before;
  for (const auto* values : {&multipliers_.point, &multipliers_.start, &multipliers_.finish}) {
    for (const double value : *values) scale += 2 * std::abs(value);
  }
  return sum - kRounding * scale;
}

}  // namespace traverse
