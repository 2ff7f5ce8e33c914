#include "engine/proof/linked_optimum.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "engine/cost/link_cost.h"

namespace traverse {
namespace {

// Of the children of a node of free order; more have too many sets.
constexpr size_t kMostChildren = 16;

// Ways to have come somewhere that are kept to read the route from, of 16 bytes.
constexpr size_t kMostSteps = 1'000'000;

class Optimum {
 public:
  Optimum(const LayerProblem& problem, int64_t most_links, Budget& budget)
      : problem_(problem), cost_(problem), links_left_(most_links), budget_(budget) {}

  std::optional<Route> Find() {
    Ends ends = {End{cost_.Before(), 0, -1}};
    if (!problem_.plan->nodes.empty()) ends = Do(0, ends);
    if (ends.empty()) return std::nullopt;  // it was given up
    for (End& end : ends) end.cost += cost_.ToFinish(end.left);
    return RouteTo(Cheapest(ends).step);
  }

 private:
  // The cheapest way to have done what is done with this path last.
  struct End {
    LinkCost::Left left;
    double cost;
    int step;  // -1: nothing is done
  };
  using Ends = std::vector<End>;

  struct Step {
    Visit visit;
    int before;
  };

  static const End& Cheapest(const Ends& ends) {
    return *std::min_element(ends.begin(), ends.end(),
                             [](const End& a, const End& b) { return a.cost < b.cost; });
  }

  // The ends after all that is below `node`; none if this takes too long.
  Ends Do(int node, const Ends& from) {
    const PlanNode& what = problem_.plan->nodes[static_cast<size_t>(node)];
    if (what.kind == PlanNode::Kind::kPath) return DoPath(what.path, from);
    if (what.kind == PlanNode::Kind::kAnyOrder) return DoInAnyOrder(what, from);
    Ends ends = from;
    for (const int child : what.children) ends = Do(child, ends);
    return ends;
  }

  Ends DoPath(int p, const Ends& from) {
    const Path& path = problem_.plan->paths[static_cast<size_t>(p)];
    const size_t entries = ExitCount(path);
    links_left_ -= static_cast<int64_t>(from.size() * entries);
    Ends ends;
    const auto enter = [&](int entry) {
      if (IsOver()) return;
      const Visit visit{p, entry};
      double least = std::numeric_limits<double>::infinity();
      int before = -1;
      for (const End& end : from) {
        if (end.cost + cost_.AtLeastTo(end.left, visit) >= least) continue;
        if (budget_.Exhausted()) return;
        const double cost = end.cost + cost_.To(end.left, visit);
        if (cost >= least) continue;
        least = cost;
        before = end.step;
      }
      ends.push_back({cost_.After(visit), least, static_cast<int>(steps_.size())});
      steps_.push_back({visit, before});
    };
    std::for_each(path.allowed.begin(), path.allowed.end(), enter);
    for (size_t e = 0; path.allowed.empty() && e < entries; ++e) enter(static_cast<int>(e));
    return IsOver() ? Ends() : ends;
  }

  bool IsOver() { return links_left_ < 0 || steps_.size() >= kMostSteps || budget_.Exhausted(); }

  Ends DoInAnyOrder(const PlanNode& node, const Ends& from) {
    const size_t children = node.children.size();
    if (children > kMostChildren) return {};
    std::vector<size_t> needs(children);  // [child] the set of those that come before it
    for (const auto& [first, second] : node.before) {
      needs[static_cast<size_t>(second)] |= size_t{1} << first;
    }
    std::vector<Ends> done(size_t{1} << children);  // [set of children]
    done[0] = from;
    for (size_t set = 0; set + 1 < done.size(); ++set) {
      const Ends ends = std::exchange(done[set], Ends());
      for (size_t child = 0; child < children && !ends.empty(); ++child) {
        const size_t one = size_t{1} << child;
        if ((set & one) != 0 || (needs[child] & ~set) != 0) continue;
        const Ends longer = Do(node.children[child], ends);
        if (longer.empty()) return {};
        Ends& all = done[set | one];
        all.insert(all.end(), longer.begin(), longer.end());
      }
    }
    return std::move(done.back());
  }

  Route RouteTo(int step) const {
    Route route;
    for (; step >= 0; step = steps_[static_cast<size_t>(step)].before) {
      route.push_back(steps_[static_cast<size_t>(step)].visit);
    }
    std::reverse(route.begin(), route.end());
    return route;
  }

  const LayerProblem& problem_;
  const LinkCost cost_;
  int64_t links_left_;
  Budget& budget_;
  std::vector<Step> steps_;
};

}  // namespace

std::optional<Route> LinkedOptimum(const LayerProblem& problem, int64_t most_links,
                                   Budget& budget) {
  assert(problem.links != nullptr && LinksFit(*problem.links, *problem.plan));
  return Optimum(problem, most_links, budget).Find();
}

}  // namespace traverse
