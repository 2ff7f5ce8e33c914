#include "engine/proof/trees/tree_bound.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "engine/base/rest.h"
#include "engine/base/resting_sort.h"
#include "engine/cost/neighbor_lists.h"
#include "engine/geometry/set_distance.h"

namespace traverse {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Near pairs of each end that an ascent begins with.
constexpr int kNeighbors = 10;

constexpr int kNeighborsOfTwo = 3;  // where there are two sides to be joined by one move

// Of the ascent.
constexpr double kFirstFactor = 1;
constexpr double kDeflection = 0.5;  // share of the last direction that is kept
constexpr int kStepsWithoutGain = 6;

// What rounding can add up to in a sum over all moves, relative to the numbers summed up.
constexpr double kRounding = 1e-12;

}  // namespace

struct TreeBound::Pool {
  explicit Pool(size_t members)
      : low_x(members),
        high_x(members),
        low_y(members),
        high_y(members),
        multiplier(members),
        key(members, kFar),
        partner(members, -1),
        wants(members),
        member(members),
        position(members) {}

  size_t size() const { return member.size(); }

  void Set(size_t at, const Junction& junction, int index, const EndGraph& graph, double of_end) {
    const Junction::Member& it = junction.members[static_cast<size_t>(index)];
    const BoundingBox& box = graph.ends[static_cast<size_t>(it.end)].box;
    low_x[at] = box.low().x;
    high_x[at] = box.high().x;
    low_y[at] = box.low().y;
    high_y[at] = box.high().y;
    multiplier[at] = of_end;
    wants[at] = OppositeRoles(it.roles);
    member[at] = index;
    position[at] = index;
  }

  void Remove(size_t removed) {
    const size_t at = static_cast<size_t>(position[removed]);
    position[static_cast<size_t>(member.back())] = static_cast<int>(at);
    position[static_cast<size_t>(member[at])] = -1;
    for (auto* column : {&low_x, &high_x, &low_y, &high_y, &multiplier, &key}) {
      (*column)[at] = column->back();
      column->pop_back();
    }
    for (auto* column : {&partner, &wants, &member}) {
      (*column)[at] = column->back();
      column->pop_back();
    }
  }

  // [at], of members that are not joined yet
  std::vector<double> low_x, high_x, low_y, high_y, multiplier;
  std::vector<double> key;   // least cost less multipliers of a move to what is joined
  std::vector<int> partner;  // the end it goes to
  std::vector<int> wants;    // roles that the other end has to have one of
  std::vector<int> member;   // index in the junction

  std::vector<int> position;  // [member] at, -1 once it is joined
};

TreeBound::TreeBound(const LayerProblem& problem, Budget& budget)
    : graph_(PlanTree(*problem.plan, &budget), &budget),
      cost_(problem),
      multipliers_(graph_.ends.size()),
      best_multipliers_(graph_.ends.size()),
      near_(graph_.ends.size()),
      member_of_(graph_.ends.size(), -1) {
  if (budget.ExhaustedNow()) return;
  for (const int end : graph_.first) start_costs_.push_back(CostTo(problem.start, end));
  for (const int end : graph_.last) {
    finish_costs_.push_back(problem.finish ? CostTo(*problem.finish, end) : 0);
  }
  first_side_.push_back(0);
  for (const Junction& junction : graph_.junctions) {
    first_side_.push_back(first_side_.back() + junction.sides);
  }
  FindNearPairs(budget);
}

void TreeBound::Clear(Budget& budget) {
  graph_.Clear(&budget);
  Rest rest(&budget);
  for (; !near_.empty(); near_.pop_back()) rest(16);
}

double TreeBound::CostTo(Point point, int end) const {
  double nearest = kFar;
  for (const Point& other : graph_.ends[static_cast<size_t>(end)].points) {
    nearest = std::min(nearest, Distance(point, other));
  }
  return cost_.OfLength(nearest);
}

double TreeBound::Cost(int a, int b, Budget& budget) const {
  return cost_.OfLength(LeastDistance(graph_.ends[static_cast<size_t>(a)].points,
                                      graph_.ends[static_cast<size_t>(b)].points, budget));
}

void TreeBound::AddPair(int junction, const Junction::Member& a, const Junction::Member& b,
                        Budget& budget) {
  const auto& known = near_[static_cast<size_t>(a.end)];
  if (std::any_of(known.begin(), known.end(),
                  [&](const auto& pair) { return pair.first == b.end; })) {
    return;
  }
  const double cost = Cost(a.end, b.end, budget);
  pairs_.push_back(Pair{junction, {a.end, b.end}, {a.side, b.side}, cost});
  near_[static_cast<size_t>(a.end)].emplace_back(b.end, cost);
  near_[static_cast<size_t>(b.end)].emplace_back(a.end, cost);
}

void TreeBound::FindNearPairs(Budget& budget) {
  Rest rest(&budget);
  for (size_t j = 0; j < graph_.junctions.size() && !budget.ExhaustedNow(); ++j) {
    const Junction& junction = graph_.junctions[j];
    PointGroups groups;
    std::vector<NeighborLists::Member> members;
    for (const Junction::Member& member : junction.members) {
      rest(16);
      members.push_back({groups.size(), member.side});
      const auto& points = graph_.ends[static_cast<size_t>(member.end)].points;
      groups.points.insert(groups.points.end(), points.begin(), points.end());
      groups.Close();
    }
    NeighborLists lists(groups);
    lists.FindAmong(members, junction.sides > 2 ? kNeighbors : kNeighborsOfTwo, budget);
    lists.Seal(&budget);
    for (int m = 0; m < groups.size(); ++m) {
      const Junction::Member& member = junction.members[static_cast<size_t>(m)];
      for (const NeighborLists::Neighbor& neighbor : lists.of(m)) {
        const Junction::Member& other = junction.members[static_cast<size_t>(neighbor.group)];
        if ((member.roles & OppositeRoles(other.roles)) == 0) continue;
        if (!rest(64)) return;
        AddPair(static_cast<int>(j), member, other, budget);
      }
    }
  }
}

void TreeBound::ReachByBoxes(const Junction::Member& from, Pool& pool) const {
  const BoundingBox& box = graph_.ends[static_cast<size_t>(from.end)].box;
  const Point low = box.low();
  const Point high = box.high();
  const double multiplier = multipliers_[static_cast<size_t>(from.end)];
  const bool is_length = cost_.is_length();
  const size_t count = pool.size();
  for (size_t at = 0; at < count; ++at) {
    const double dx = std::max(std::max(pool.low_x[at] - high.x, low.x - pool.high_x[at]), 0.0);
    const double dy = std::max(std::max(pool.low_y[at] - high.y, low.y - pool.high_y[at]), 0.0);
    const double length = std::sqrt(dx * dx + dy * dy);
    const double cost = is_length ? length : cost_.OfLength(length);
    const double key = cost - multiplier - pool.multiplier[at];
    const bool nearer = key < pool.key[at] && (from.roles & pool.wants[at]) != 0;
    pool.key[at] = nearer ? key : pool.key[at];
    pool.partner[at] = nearer ? from.end : pool.partner[at];
  }
}

// Updates the keys of all that is not joined for one end that is: for known pairs by their true
// costs, for others by those of boxes.
void TreeBound::Reach(const Junction::Member& from, Pool& pool) const {
  struct Known {
    size_t at = 0;
    double key = 0;
    int partner = 0;
    double cost = 0;
  };
  std::vector<Known> known;
  for (const auto& [other, cost] : near_[static_cast<size_t>(from.end)]) {
    const int member = member_of_[static_cast<size_t>(other)];
    if (member < 0 || pool.position[static_cast<size_t>(member)] < 0) continue;
    const size_t at = static_cast<size_t>(pool.position[static_cast<size_t>(member)]);
    known.push_back({at, pool.key[at], pool.partner[at], cost});
  }
  ReachByBoxes(from, pool);
  for (const Known& it : known) {
    const double key =
        it.cost - multipliers_[static_cast<size_t>(from.end)] - pool.multiplier[it.at];
    const bool nearer = key < it.key && (from.roles & pool.wants[it.at]) != 0;
    pool.key[it.at] = nearer ? key : it.key;
    pool.partner[it.at] = nearer ? from.end : it.partner;
  }
}

// Prim's algorithm over the sides of a junction. Returns the sum of the tree's costs less
// multipliers, counts its moves, and makes its pairs known.
double TreeBound::JoinAll(int index, Budget& budget) {
  const Junction& junction = graph_.junctions[static_cast<size_t>(index)];
  const size_t count = junction.members.size();
  Pool pool(count);
  std::vector<size_t> first(static_cast<size_t>(junction.sides) + 1, count);  // [side] member
  for (size_t m = count; m-- > 0;) {
    const Junction::Member& member = junction.members[m];
    pool.Set(m, junction, static_cast<int>(m), graph_,
             multipliers_[static_cast<size_t>(member.end)]);
    first[static_cast<size_t>(member.side)] = m;
    member_of_[static_cast<size_t>(member.end)] = static_cast<int>(m);
  }
  std::vector<std::pair<int, int>> chosen;  // members
  double sum = 0;
  size_t side = 0;
  for (int joined = 1; !budget.Exhausted(); ++joined) {
    for (size_t m = first[side]; m < first[side + 1]; ++m) pool.Remove(m);
    if (joined == junction.sides) break;
    for (size_t m = first[side]; m < first[side + 1]; ++m) Reach(junction.members[m], pool);
    const size_t at =
        static_cast<size_t>(std::min_element(pool.key.begin(), pool.key.end()) - pool.key.begin());
    const int partner = member_of_[static_cast<size_t>(pool.partner[at])];
    chosen.emplace_back(pool.member[at], partner);
    sum += pool.key[at];
    side = static_cast<size_t>(junction.members[static_cast<size_t>(pool.member[at])].side);
  }
  for (const Junction::Member& member : junction.members) {
    member_of_[static_cast<size_t>(member.end)] = -1;
  }
  Rest rest(&budget);
  for (const auto& [a, b] : chosen) {
    const Junction::Member& one = junction.members[static_cast<size_t>(a)];
    const Junction::Member& other = junction.members[static_cast<size_t>(b)];
    ++moves_[static_cast<size_t>(one.end)];
    ++moves_[static_cast<size_t>(other.end)];
    rest(64);
    AddPair(index, one, other, budget);
  }
  return sum;
}

// The least costs less multipliers of the moves from the start and to the finish, and what is paid
// back.
double TreeBound::AddFirstAndLast() {
  double sum = 0;
  const auto add = [&](const std::vector<int>& ends, const std::vector<double>& costs,
                       uint8_t role) {
    double least = kFar;
    int best = 0;
    for (size_t i = 0; i < ends.size(); ++i) {
      if ((graph_.ends[static_cast<size_t>(ends[i])].roles & role) == 0) continue;
      const double cost = costs[i] - multipliers_[static_cast<size_t>(ends[i])];
      if (cost >= least) continue;
      least = cost;
      best = ends[i];
    }
    ++moves_[static_cast<size_t>(best)];
    sum += least;
  };
  add(graph_.first, start_costs_, PathEnd::kEnter);
  add(graph_.last, finish_costs_, PathEnd::kLeave);
  for (size_t end = 0; end < graph_.ends.size(); ++end) {
    sum += graph_.ends[end].moves * multipliers_[end];
  }
  return sum;
}

bool TreeBound::Evaluate(Budget& budget) {
  moves_.assign(graph_.ends.size(), 0);
  double sum = AddFirstAndLast();
  double scale = std::abs(sum);
  for (size_t j = 0; j < graph_.junctions.size(); ++j) {
    const double tree = JoinAll(static_cast<int>(j), budget);
    if (budget.was_exhausted()) return false;
    sum += tree;
    scale += std::abs(tree);
  }
  for (const double multiplier : multipliers_) scale += 2 * std::abs(multiplier);
  const double bound = sum - kRounding * scale;
  if (bound > lower_bound_) {
    lower_bound_ = bound;
    best_multipliers_ = multipliers_;
  }
  return true;
}

// Kruskal's algorithm over the near pairs of all junctions at once. REQUIRES: these connect the
// sides of each.
double TreeBound::EvaluateNear(Budget& budget) {
  moves_.assign(graph_.ends.size(), 0);
  double sum = AddFirstAndLast();
  sorted_.clear();
  Rest rest(&budget);
  for (size_t p = 0; p < pairs_.size(); ++p) {
    rest(2);
    const Pair& pair = pairs_[p];
    sorted_.emplace_back(pair.cost - multipliers_[static_cast<size_t>(pair.ends[0])] -
                             multipliers_[static_cast<size_t>(pair.ends[1])],
                         static_cast<int>(p));
  }
  RestingSort(sorted_, rest);
  joined_.Reset(first_side_.back());
  for (const auto& [cost, index] : sorted_) {
    rest(8);
    const Pair& pair = pairs_[static_cast<size_t>(index)];
    const int base = first_side_[static_cast<size_t>(pair.junction)];
    if (!joined_.Join(base + pair.sides[0], base + pair.sides[1])) continue;
    sum += cost;
    for (const int end : pair.ends) ++moves_[static_cast<size_t>(end)];
  }
  return sum;
}

std::vector<double> TreeBound::Subgradient() const {
  std::vector<double> gradient(moves_.size());
  for (size_t end = 0; end < moves_.size(); ++end) {
    gradient[end] = graph_.ends[end].moves - moves_[end];
  }
  return gradient;
}

void TreeBound::Ascend(double target, int most_steps, Budget& budget) {
  std::vector<double> best = multipliers_;
  std::vector<double> direction(multipliers_.size());
  double best_value = -kFar;
  double factor = kFirstFactor;
  int without_gain = 0;
  for (int step = 0; step < most_steps && !budget.ExhaustedNow(); ++step) {
    const double value = EvaluateNear(budget);
    if (value > best_value) {
      best_value = value;
      best = multipliers_;
      without_gain = 0;
    } else if (++without_gain == kStepsWithoutGain) {
      without_gain = 0;
      factor /= 2;
      multipliers_ = best;
      EvaluateNear(budget);
    }
    const std::vector<double> gradient = Subgradient();
    double square = 0;
    for (size_t end = 0; end < gradient.size(); ++end) {
      direction[end] = gradient[end] + kDeflection * direction[end];
      square += direction[end] * direction[end];
    }
    if (square == 0 || value >= target) break;
    const double length = factor * (target - value) / square;
    for (size_t end = 0; end < gradient.size(); ++end) {
      multipliers_[end] += length * direction[end];
    }
  }
  multipliers_ = best;
}

}  // namespace traverse
