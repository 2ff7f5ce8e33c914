#include "engine/weller/tabu/point_relinking.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "engine/base/tolerances.h"

namespace traverse {
namespace {

// [position] an index into SequencedPoints::vertices of that position.
using Choice = std::vector<size_t>;

class Relinking {
 public:
  Relinking(const SequencedPoints& sequence, const TravelCost& cost)
      : sequence_(sequence), cost_(cost) {}

  Choice Nearest(const std::vector<Point>& near) const {
    Choice choice;
    for (size_t k = 0; k < size(); ++k) {
      size_t best = 0;
      for (size_t v = 1; v < sequence_.vertices[k].size(); ++v) {
        if (Distance(At(k, v), near[k]) < Distance(At(k, best), near[k])) best = v;
      }
      choice.push_back(best);
    }
    return choice;
  }

  Choice Random(Rng& rng) const {
    Choice choice;
    for (size_t k = 0; k < size(); ++k) {
      choice.push_back(rng.Below(static_cast<uint32_t>(sequence_.vertices[k].size())));
    }
    return choice;
  }

  double Cost(const Choice& choice) const {
    double sum = 0;
    for (size_t k = 0; k < size(); ++k) sum += cost_(Before(choice, k), At(k, choice[k]));
    return sum;
  }

  // Goes from `from` to the guide. True if it met a shorter route, which is the guide then.
  bool Walk(Choice from, Choice& guide, double& guide_cost) const {
    double cost = Cost(from);
    std::vector<size_t> differing;
    for (size_t k = 0; k < size(); ++k) {
      if (from[k] != guide[k]) differing.push_back(k);
    }
    while (cost >= guide_cost - kImprovementTolerance) {
      if (differing.empty()) return false;
      size_t best = 0;
      double least = std::numeric_limits<double>::infinity();
      for (size_t d = 0; d < differing.size(); ++d) {
        const double delta = Delta(from, differing[d], guide[differing[d]]);
        if (delta >= least) continue;
        least = delta;
        best = d;
      }
      from[differing[best]] = guide[differing[best]];
      differing.erase(differing.begin() + static_cast<std::ptrdiff_t>(best));
      cost += least;
    }
    guide = from;
    guide_cost = Cost(guide);
    return true;
  }

  Route RouteOf(const Choice& choice) const {
    Route route;
    for (size_t k = 0; k < size(); ++k) {
      route.push_back(Visit{sequence_.order[k], sequence_.vertices[k][choice[k]]});
    }
    return route;
  }

 private:
  size_t size() const { return sequence_.order.size(); }
  Point At(size_t k, size_t v) const {
    const Path& path = sequence_.plan->paths[static_cast<size_t>(sequence_.order[k])];
    return path.points[static_cast<size_t>(sequence_.vertices[k][v])];
  }
  Point Before(const Choice& choice, size_t k) const {
    return k > 0 ? At(k - 1, choice[k - 1]) : sequence_.start;
  }
  double Around(const Choice& choice, size_t k, Point point) const {
    const double arrival = cost_(Before(choice, k), point);
    return k + 1 < size() ? arrival + cost_(point, At(k + 1, choice[k + 1])) : arrival;
  }
  double Delta(const Choice& choice, size_t k, size_t v) const {
    return Around(choice, k, At(k, v)) - Around(choice, k, At(k, choice[k]));
  }

  const SequencedPoints& sequence_;
  const TravelCost& cost_;
};

}  // namespace

Route RelinkPoints(const SequencedPoints& sequence, const std::vector<Point>& near,
                   const TravelCost& cost, int rounds, Rng& rng, Budget& budget) {
  const Relinking relinking(sequence, cost);
  Choice guide = relinking.Nearest(near);
  double guide_cost = relinking.Cost(guide);
  for (int round = 0; round < rounds && !budget.Exhausted(); ++round) {
    relinking.Walk(relinking.Random(rng), guide, guide_cost);
  }
  return relinking.RouteOf(guide);
}

}  // namespace traverse
