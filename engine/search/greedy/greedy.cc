#include "engine/search/greedy/greedy.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/cost/route_cost.h"
#include "engine/search/greedy/frontier.h"

namespace traverse {
namespace {

class Greedy {
 public:
  Greedy(const LayerView& layer, Budget& budget)
      : layer_(layer), budget_(budget), frontiers_(layer, budget), at_(layer.problem.start) {}

  // Incomplete if the search was cancelled.
  Route Build() {
    route_.reserve(layer_.plan().paths.size());
    if (!layer_.plan().paths.empty()) Complete(0);
    return std::move(route_);
  }

 private:
  // Returns nothing once nobody wants the route any more.
  void Complete(int node) {
    if (budget_.was_exhausted() && budget_.cancelled()) return;
    const absl::Span<const int> children = layer_.tree.children(node);
    if (layer_.tree.is_leaf(node)) {
      VisitAt(NearestEntry(layer_.tree.node(node).path));
    } else if (children.size() > 1 && layer_.tree.node(node).kind == PlanNode::Kind::kAnyOrder) {
      CompleteAnyOrder(node);
    } else {
      for (const int child : children) Complete(child);
    }
  }

  void CompleteAnyOrder(int node) {
    const absl::Span<const int> children = layer_.tree.children(node);
    // Not worth a frontier any more.
    if (budget_.Exhausted()) return CompleteInSomeOrder(node);
    Frontier& frontier = frontiers_.Of(node);
    if (budget_.was_exhausted() && budget_.cancelled()) return;
    for (size_t done = 0; done < children.size(); ++done) {
      const bool late = budget_.Exhausted();
      if (late && budget_.cancelled()) return;
      if (late) frontier.StopSearching();
      const Frontier::Found next = late ? frontier.Any() : frontier.Nearest(at_);
      const int child = children[static_cast<size_t>(next.slot)];
      frontier.Begin(next.slot);
      if (layer_.tree.is_leaf(child) && next.entry >= 0) {
        VisitAt(next.entry);
      } else {
        // Begins with the entry just found, as it looks for the nearest among the same ones.
        Complete(child);
      }
      frontier.Finish(next.slot);
    }
    frontiers_.Drop(node);
  }

  void CompleteInSomeOrder(int node) {
    const absl::Span<const int> children = layer_.tree.children(node);
    std::vector<int> slots;
    const auto note = [&](int slot) { slots.push_back(slot); };
    ReadySlots ready(layer_.tree.precedence(node), static_cast<int>(children.size()), note);
    while (!slots.empty() && !budget_.cancelled()) {
      const int slot = slots.back();
      slots.pop_back();
      Complete(children[static_cast<size_t>(slot)]);
      ready.Finish(slot, note);
    }
  }

  int NearestEntry(int path) const {
    const absl::Span<const Point> enters = layer_.table.enters(path);
    size_t nearest = 0;
    for (size_t i = 1; i < enters.size(); ++i) {
      if (Distance(at_, enters[i]) < Distance(at_, enters[nearest])) nearest = i;
    }
    return layer_.table.first(path) + static_cast<int>(nearest);
  }

  void VisitAt(int entry) {
    route_.push_back(layer_.table.VisitOf(entry));
    at_ = layer_.table.exit(entry);
  }

  const LayerView& layer_;
  Budget& budget_;
  Frontier::Forest frontiers_;
  Point at_;
  Route route_;
};

}  // namespace

Route GreedyRoute(const LayerView& layer, Budget& budget) {
  Route greedy = Greedy(layer, budget).Build();
  return greedy.size() == layer.plan().paths.size() ? greedy : GivenRoute(layer.plan());
}

Route BaselineRoute(const LayerView& layer, Budget& budget) {
  Route given = GivenRoute(layer.plan(), &budget);
  if (budget.Exhausted()) return given;
  Route greedy = Greedy(layer, budget).Build();
  if (greedy.size() != given.size()) return given;
  const double cost = RouteCostInTime(layer.problem, greedy, budget);
  if (std::isinf(cost)) return given;
  return cost < RouteCostInTime(layer.problem, given, budget) ? greedy : given;
}

}  // namespace traverse
