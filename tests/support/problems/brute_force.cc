#include "tests/support/problems/brute_force.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace traverse::testing {
namespace {

using Orders = std::vector<std::vector<int>>;

Orders OrdersOf(const Plan& plan, int index);

// Every travel to do one child after the other.
Orders Concatenated(const std::vector<Orders>& parts, const std::vector<int>& sequence) {
  Orders result = {{}};
  for (const int child : sequence) {
    Orders longer;
    for (const std::vector<int>& head : result) {
      for (const std::vector<int>& tail : parts[static_cast<size_t>(child)]) {
        longer.push_back(head);
        longer.back().insert(longer.back().end(), tail.begin(), tail.end());
      }
    }
    result = std::move(longer);
  }
  return result;
}

bool Keeps(const PlanNode& node, const std::vector<int>& sequence) {
  std::vector<size_t> position(sequence.size());
  for (size_t i = 0; i < sequence.size(); ++i) position[static_cast<size_t>(sequence[i])] = i;
  return std::all_of(node.before.begin(), node.before.end(), [&](const std::pair<int, int>& pair) {
    return position[static_cast<size_t>(pair.first)] < position[static_cast<size_t>(pair.second)];
  });
}

Orders OrdersOf(const Plan& plan, int index) {
  const PlanNode& node = plan.nodes[static_cast<size_t>(index)];
  if (node.kind == PlanNode::Kind::kPath) return {{node.path}};
  std::vector<Orders> parts;
  for (const int child : node.children) parts.push_back(OrdersOf(plan, child));
  std::vector<int> sequence(node.children.size());
  std::iota(sequence.begin(), sequence.end(), 0);
  if (node.kind == PlanNode::Kind::kInOrder) return Concatenated(parts, sequence);
  Orders result;
  do {
    if (!Keeps(node, sequence)) continue;
    Orders some = Concatenated(parts, sequence);
    std::move(some.begin(), some.end(), std::back_inserter(result));
  } while (std::next_permutation(sequence.begin(), sequence.end()));
  return result;
}

std::vector<int> EntriesOf(const Path& path) {
  if (path.kind == Path::Kind::kOpen) return path.one_way ? std::vector{0} : std::vector{0, 1};
  if (!path.allowed.empty()) return path.allowed;
  std::vector<int> all(path.points.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// One travel to reach the end of a prefix of the order, the best for its last entry.
struct Partial {
  double cost = 0;
  Point end;
  Route route;
};

const Partial& Cheapest(const std::vector<Partial>& partials) {
  return *std::min_element(partials.begin(), partials.end(),
                           [](const Partial& a, const Partial& b) { return a.cost < b.cost; });
}

}  // namespace

double MoveCost(const CostSpec& spec, Point from, Point to) {
  const double length = std::hypot(from.x - to.x, from.y - to.y);
  if (spec.kind == CostSpec::Kind::kLength) return length;
  double seconds = length / spec.speed_mm_s;
  if (spec.accel_mm_s2 > 0) {
    const double ramp_seconds = spec.speed_mm_s / spec.accel_mm_s2;
    const double both_ramps_mm = spec.speed_mm_s * ramp_seconds;
    seconds = length < both_ramps_mm
                  ? 2 * std::sqrt(length / spec.accel_mm_s2)
                  : 2 * ramp_seconds + (length - both_ramps_mm) / spec.speed_mm_s;
  }
  return seconds + (length > spec.retraction_threshold_mm ? spec.retraction_seconds : 0);
}

std::vector<std::vector<int>> LegalOrders(const Plan& plan) {
  return plan.nodes.empty() ? Orders{{}} : OrdersOf(plan, 0);
}

BruteForceResult BestEntries(const LayerProblem& problem, const std::vector<int>& order,
                             const MoveFunction& cost) {
  const auto move_cost = [&](Point from, Point to) {
    return cost ? cost(from, to) : MoveCost(problem.cost, from, to);
  };
  std::vector<Partial> partials = {{0, problem.start, {}}};
  for (const int index : order) {
    const Path& path = problem.plan->paths[static_cast<size_t>(index)];
    std::vector<Partial> longer;
    for (const int entry : EntriesOf(path)) {
      std::vector<Partial> travels = partials;
      for (Partial& travel : travels) {
        travel.cost += move_cost(travel.end, EnterPoint(path, entry));
        travel.end = ExitPoint(path, entry);
      }
      longer.push_back(Cheapest(travels));
      longer.back().route.push_back(Visit{index, entry});
    }
    partials = std::move(longer);
  }
  if (problem.finish) {
    for (Partial& travel : partials) travel.cost += move_cost(travel.end, *problem.finish);
  }
  const Partial& best = Cheapest(partials);
  return {best.cost, best.route};
}

BruteForceResult BruteForce(const LayerProblem& problem, const MoveFunction& cost) {
  BruteForceResult best{std::numeric_limits<double>::infinity(), {}};
  for (const std::vector<int>& order : LegalOrders(*problem.plan)) {
    BruteForceResult result = BestEntries(problem, order, cost);
    if (result.cost < best.cost) best = std::move(result);
  }
  return best;
}

}  // namespace traverse::testing
