#include "engine/proof/small_parts/small_parts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/base/rest.h"
#include "engine/base/tolerances.h"
#include "engine/validator.h"

namespace traverse {
namespace {

// What running through a node takes: per state before it and once; and how many states follow.
struct Effort {
  double per_state = 0;
  double once = 0;
  double states = 0;
  bool has_choice = false;  // an order or an entry
};

std::vector<Effort> EffortsOf(const LayerView& layer, int most_children, Budget* budget) {
  Rest rest(budget);
  std::vector<Effort> efforts(layer.plan().nodes.size());
  for (int index = layer.tree.node_count(); index-- > 0;) {
    Effort& effort = efforts[static_cast<size_t>(index)];
    rest(4);
    if (layer.tree.path_count(index) == 0) continue;
    if (layer.tree.is_leaf(index)) {
      effort.per_state = effort.states = layer.table.count(layer.tree.node(index).path);
      effort.has_choice = effort.states > 1;
      continue;
    }
    const absl::Span<const int> children = layer.tree.children(index);
    const bool any_order = layer.tree.node(index).kind == PlanNode::Kind::kAnyOrder;
    const double k = static_cast<double>(children.size());
    effort.has_choice = any_order && k > 1;
    const double sets = std::exp2(k - 1);
    double states_before = 0;
    for (const int child : children) {
      rest(4);
      const Effort& below = efforts[static_cast<size_t>(child)];
      effort.has_choice = effort.has_choice || below.has_choice;
      if (!any_order) {
        if (child == children.front()) effort.per_state = below.per_state;
        effort.once += below.once + below.per_state * states_before;
        effort.states = states_before = below.states;
        continue;
      }
      // Each other child is in a quarter of the sets that this one is not in.
      effort.per_state += below.per_state;
      effort.once += below.once * sets;
      effort.states += below.states;
    }
    if (!any_order) continue;
    for (const int child : children) {
      rest(2);
      const Effort& below = efforts[static_cast<size_t>(child)];
      effort.once += below.per_state * (effort.states - below.states) * (sets / 2);
    }
    if (k > most_children) effort.once = std::numeric_limits<double>::infinity();
  }
  return efforts;
}

class SubsetSearch {
 public:
  // The last visit of a sequence: a record of it, its exit, and the least cost until then.
  struct State {
    Point exit;
    double cost = 0;
    int record = -1;
  };
  using States = std::vector<State>;

  SubsetSearch(const LayerView& layer, Budget& budget) : layer_(layer), budget_(budget) {}

  // The states after `node` was done from one of `before`. Empty if the budget ran out.
  States Run(int node, const States& before) {
    if (layer_.tree.is_leaf(node)) return RunPath(layer_.tree.node(node).path, before);
    if (layer_.tree.node(node).kind == PlanNode::Kind::kInOrder) {
      States states = before;
      for (const int child : layer_.tree.children(node)) states = Run(child, states);
      return states;
    }
    return RunAnyOrder(node, before);
  }

  // The visits that a state of the last Run came from.
  Route RouteTo(const State& state) const {
    Route route;
    for (int at = state.record; at >= 0; at = records_[static_cast<size_t>(at)].before) {
      route.push_back(layer_.table.VisitOf(records_[static_cast<size_t>(at)].entry));
    }
    std::reverse(route.begin(), route.end());
    return route;
  }

  void Forget() { records_.clear(); }

 private:
  struct Record {
    int entry = 0;
    int before = -1;
  };

  States RunPath(int path, const States& before) {
    States after;
    if (before.empty() || budget_.Exhausted()) return after;
    for (int entry = layer_.table.first(path); entry < layer_.table.first(path + 1); ++entry) {
      const Point enter = layer_.table.enter(entry);
      double least = std::numeric_limits<double>::infinity();
      int best = 0;
      for (const State& state : before) {
        const double cost = state.cost + layer_.cost(state.exit, enter);
        if (cost >= least) continue;
        least = cost;
        best = state.record;
      }
      after.push_back({layer_.table.exit(entry), least, static_cast<int>(records_.size())});
      records_.push_back({entry, best});
    }
    return after;
  }

  States RunAnyOrder(int node, const States& before) {
    const absl::Span<const int> children = layer_.tree.children(node);
    const std::vector<uint32_t>& needed = NeededBefore(node);
    const uint32_t all = (uint32_t{1} << children.size()) - 1;
    std::vector<States> after(all + 1);  // [set of children]
    after[0] = before;
    for (uint32_t set = 0; set < all; ++set) {
      const States states = std::move(after[set]);
      if (states.empty()) continue;
      for (size_t c = 0; c < children.size(); ++c) {
        const uint32_t bit = uint32_t{1} << c;
        if ((set & bit) != 0 || (needed[c] & ~set) != 0) continue;
        const States one = Run(children[c], states);
        after[set | bit].insert(after[set | bit].end(), one.begin(), one.end());
      }
      after[set].clear();
    }
    return std::move(after[all]);
  }

  // [slot] the slots that come before it, as a set. Pairs through children without paths count.
  // Known from the first time on: a node may have many such children, and is come by often.
  const std::vector<uint32_t>& NeededBefore(int node) {
    const auto [known, is_new] = needed_.try_emplace(node);
    if (!is_new) return known->second;
    std::vector<uint32_t>& needed = known->second;
    needed.resize(layer_.tree.children(node).size());
    const Precedence& precedence = layer_.tree.precedence(node);
    if (precedence.empty()) return needed;
    const std::vector<uint64_t> before = precedence.SlotsBefore(0);
    for (size_t slot = 0; slot < needed.size(); ++slot) {
      needed[slot] = static_cast<uint32_t>(before[slot]);
    }
    return needed;
  }

  const LayerView& layer_;
  Budget& budget_;
  std::vector<Record> records_;
  std::unordered_map<int, std::vector<uint32_t>> needed_;  // [node]
};

class SmallPartSolver {
 public:
  SmallPartSolver(const LayerView& layer, const SmallPartOptions& options, Route& route,
                  Budget& budget)
      : layer_(layer),
        options_(options),
        efforts_(EffortsOf(layer, options.most_children, &budget)),
        route_(route),
        budget_(budget),
        search_(layer, budget) {}

  bool Run() {
    if (route_.empty()) return true;
    Visit(0, 0);
    return IsSmall(0) && !budget_.was_exhausted();
  }

 private:
  bool IsSmall(int node) const {
    const Effort& effort = efforts_[static_cast<size_t>(node)];
    const double share =
        static_cast<double>(layer_.tree.path_count(node)) / static_cast<double>(route_.size());
    return effort.per_state + effort.once <= options_.most_operations * share;
  }

  // `first`: position of the node's first path in the route, which the order of the children in it
  // follows.
  void Visit(int node, size_t first) {
    const Effort& effort = efforts_[static_cast<size_t>(node)];
    if (!effort.has_choice || budget_.ExhaustedNow()) return;
    if (IsSmall(node)) {
      Solve(node, first);
      return;
    }
    if (layer_.tree.is_leaf(node)) return;
    const size_t end = first + static_cast<size_t>(layer_.tree.path_count(node));
    while (first < end) {
      int child = layer_.tree.leaf(route_[first].path);
      while (layer_.tree.parent(child) != node) child = layer_.tree.parent(child);
      Visit(child, first);
      first += static_cast<size_t>(layer_.tree.path_count(child));
    }
  }

  void Solve(int node, size_t first) {
    const size_t end = first + static_cast<size_t>(layer_.tree.path_count(node));
    const Point from = first == 0 ? layer_.problem.start
                                  : layer_.table.exit(layer_.table.EntryOf(route_[first - 1]));
    const std::optional<Point> to = end == route_.size()
                                        ? layer_.problem.finish
                                        : layer_.table.enter(layer_.table.EntryOf(route_[end]));
    search_.Forget();
    const SubsetSearch::States states = search_.Run(node, {{from, 0, -1}});
    if (budget_.was_exhausted()) return;
    const auto total = [&](const SubsetSearch::State& state) {
      return state.cost + (to ? layer_.cost(state.exit, *to) : 0);
    };
    const auto best =
        std::min_element(states.begin(), states.end(),
                         [&](const auto& a, const auto& b) { return total(a) < total(b); });
    if (total(*best) >= CostOf(first, end, from, to) - kImprovementTolerance) return;
    const Route part = search_.RouteTo(*best);
    std::copy(part.begin(), part.end(), route_.begin() + static_cast<std::ptrdiff_t>(first));
  }

  double CostOf(size_t first, size_t end, Point from, const std::optional<Point>& to) const {
    double sum = 0;
    for (size_t k = first; k < end; ++k) {
      const int entry = layer_.table.EntryOf(route_[k]);
      sum += layer_.cost(from, layer_.table.enter(entry));
      from = layer_.table.exit(entry);
    }
    return sum + (to ? layer_.cost(from, *to) : 0);
  }

  const LayerView& layer_;
  const SmallPartOptions& options_;
  const std::vector<Effort> efforts_;  // [node]
  Route& route_;
  Budget& budget_;
  SubsetSearch search_;
};

}  // namespace

bool IsSmall(const LayerView& layer, const SmallPartOptions& options, Budget* budget) {
  if (layer.plan().paths.empty()) return true;
  const Effort whole = EffortsOf(layer, options.most_children, budget)[0];
  return whole.per_state + whole.once <= options.most_operations;
}

bool SolveSmallParts(const LayerView& layer, const SmallPartOptions& options, Route& route,
                     Budget& budget) {
  assert(ValidateRoute(layer.plan(), route).ok());
  return SmallPartSolver(layer, options, route, budget).Run();
}

}  // namespace traverse
