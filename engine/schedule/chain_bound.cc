#include "engine/schedule/chain_bound.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/layers_in_order.h"

namespace traverse {
namespace {

// What a layer needs of the time, however few paths it has.
size_t WeightOf(const BoundedLayer& layer) { return layer.plan.paths.size() + 1; }

}  // namespace

void ChainBound::Add(uint64_t index, BoundedLayer layer) {
  if (plans_.Add(layer.plan)) {
    layers_.emplace(index, std::move(layer));
  } else {
    layers_.clear();
  }
}

std::optional<double> ChainBound::Compute(uint64_t seed, const BoundOf& bound_of,
                                          Budget& budget) const {
  if (layers_.empty()) return std::nullopt;
  size_t left = 0;
  for (const auto& [index, layer] : layers_) left += WeightOf(layer);
  double sum = 0;
  for (auto begin = layers_.begin(); begin != layers_.end();) {
    size_t weight = 0;
    auto end = begin;
    do {
      weight += WeightOf(end->second);
      ++end;
    } while (end != layers_.end() && end->second.starts_where_last_ended);
    Budget share = budget.WithShare(static_cast<double>(weight) / static_cast<double>(left));
    const std::optional<double> bound = BoundOfPart(begin, end, seed, bound_of, share);
    if (!bound) return std::nullopt;
    sum += *bound;
    left -= weight;
    begin = end;
  }
  return sum;
}

std::optional<double> ChainBound::BoundOfPart(Iterator begin, Iterator end, uint64_t seed,
                                              const BoundOf& bound_of, Budget& budget) {
  std::vector<const Plan*> plans;
  std::vector<const Route*> routes;
  for (auto it = begin; it != end; ++it) {
    if (it->second.cost != begin->second.cost) return std::nullopt;
    plans.push_back(&it->second.plan);
    routes.push_back(&it->second.route);
  }
  const Plan all = PlanInOrder(plans);
  const Route route = RouteInOrder(routes);
  const Point start = begin->second.start;
  const LayerProblem problem{&all, start, std::prev(end)->second.finish, begin->second.cost,
                             StreamSeed(seed, begin->first)};
  const double cost = RouteCost(problem, route, &budget);
  const std::optional<double> bound = bound_of(problem, route, budget);
  if (!bound) return std::nullopt;
  const Point route_end = RouteEnd(all, route, start);
  const double finish = problem.finish ? TravelCost(problem)(route_end, *problem.finish) : 0;
  return std::min(*bound, cost) - finish;
}

}  // namespace traverse
