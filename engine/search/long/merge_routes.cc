#include "engine/search/long/merge_routes.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/base/rest.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/path.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/validator.h"

namespace traverse {
namespace {

// Visits of the longest stretch.
constexpr size_t kLongest = 1000;

// Stretches tried in one pass: each takes as long as looking at the whole route.
constexpr int kMostTries = 100;

// The visits [first, last] of a route, and where the other one has the same paths.
struct Stretch {
  size_t first;
  size_t last;
  size_t other_first;
  bool turned;  // the other's are taken backwards
  double delta;
};

// Where each visit of a route begins and ends, and what the moves cost.
struct LaidOut {
  LaidOut(const LayerProblem& problem, const TravelCost& cost, const Route& route, Budget& budget) {
    Rest rest(&budget);
    Point at = problem.start;
    cost_before.push_back(0);
    for (const Visit& visit : route) {
      rest(8);
      const Path& path = problem.plan->paths[static_cast<size_t>(visit.path)];
      in.push_back(EnterPoint(path, visit.entry));
      out.push_back(ExitPoint(path, visit.entry));
      cost_before.push_back(cost_before.back() + cost(at, in.back()));
      at = out.back();
    }
    cost_before.push_back(cost_before.back() + (problem.finish ? cost(at, *problem.finish) : 0));
  }

  // Of the moves within [first, last], and with those to and from there.
  double Inside(size_t first, size_t last) const {
    return cost_before[last + 1] - cost_before[first + 1];
  }
  double Around(size_t first, size_t last) const {
    return cost_before[last + 2] - cost_before[first];
  }

  std::vector<Point> in;            // [position]
  std::vector<Point> out;           // [position]
  std::vector<double> cost_before;  // [position]: of all moves before the one to this visit
};

Visit Turned(const Plan& plan, Visit visit) {
  const Path& path = plan.paths[static_cast<size_t>(visit.path)];
  if (path.kind == Path::Kind::kOpen) visit.entry = 1 - visit.entry;
  return visit;
}

class StretchFinder {
 public:
  StretchFinder(const LayerProblem& problem, const Route& other, const Route& route, Budget& budget)
      : problem_(problem),
        other_(other),
        route_(route),
        cost_(problem),
        other_laid_(problem, cost_, other, budget),
        laid_(problem, cost_, route, budget),
        other_position_(route.size()) {
    for (size_t i = 0; i < other.size(); ++i) {
      other_position_[static_cast<size_t>(other[i].path)] = i;
    }
  }

  // Those that would make the route cheaper, the best first.
  std::vector<Stretch> Find(Budget& budget) {
    for (size_t first = 0; first < route_.size() && !budget.Exhausted(); ++first) {
      FindFrom(first);
    }
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Stretch& a, const Stretch& b) { return a.delta < b.delta; });
    return std::move(found_);
  }

 private:
  void FindFrom(size_t first) {
    size_t low = PositionInOther(first);
    size_t high = low;
    for (size_t last = first + 1; last < route_.size() && high - low < kLongest; ++last) {
      low = std::min(low, PositionInOther(last));
      high = std::max(high, PositionInOther(last));
      if (high - low != last - first) continue;
      Try({first, last, low, false, 0}, other_[low], other_[high], other_laid_.in[low],
          other_laid_.out[high]);
      Try({first, last, low, true, 0}, Turned(*problem_.plan, other_[high]),
          Turned(*problem_.plan, other_[low]), other_laid_.out[high], other_laid_.in[low]);
    }
  }

  // `begin` and `end`: the first and the last of the other's visits, from `in` to `out`.
  void Try(Stretch stretch, const Visit& begin, const Visit& end, Point in, Point out) {
    // A shorter stretch does the same.
    if (begin == route_[stretch.first] || end == route_[stretch.last]) return;
    const size_t size = stretch.last - stretch.first;
    const double inside =
        other_laid_.Inside(stretch.other_first, stretch.other_first + size) + kImprovementTolerance;
    const double limit = laid_.Around(stretch.first, stretch.last) - inside;
    const Point before = stretch.first == 0 ? problem_.start : laid_.out[stretch.first - 1];
    const bool is_last = stretch.last + 1 == route_.size();
    const Point after = is_last ? problem_.finish.value_or(out) : laid_.in[stretch.last + 1];
    // Questions to walls take long, and most stretches need none.
    if (cost_.Base(before, in) + cost_.Base(out, after) >= limit) return;
    stretch.delta =
        cost_(before, in) + (is_last && !problem_.finish ? 0 : cost_(out, after)) - limit;
    if (stretch.delta < 0) found_.push_back(stretch);
  }

  size_t PositionInOther(size_t position) const {
    return other_position_[static_cast<size_t>(route_[position].path)];
  }

  const LayerProblem& problem_;
  const Route& other_;
  const Route& route_;
  const TravelCost cost_;
  const LaidOut other_laid_;
  const LaidOut laid_;
  std::vector<size_t> other_position_;  // [path]
  std::vector<Stretch> found_;
};

// The route with a stretch of the other one.
Route With(const Plan& plan, const Stretch& stretch, const Route& other, Route route) {
  const size_t size = stretch.last - stretch.first;
  for (size_t i = 0; i <= size; ++i) {
    route[stretch.first + i] = stretch.turned ? Turned(plan, other[stretch.other_first + size - i])
                                              : other[stretch.other_first + i];
  }
  return route;
}

// Returns whether it found a stretch to take. A plan may not allow one: the paths of a node may be
// at the other end of the stretch, or not be turned.
bool TakeStretches(const LayerProblem& problem, const Route& other, Route& route, Budget& budget) {
  std::vector<char> taken(route.size());
  double cost = RouteCost(problem, route, &budget);
  int tries = 0;
  bool any = false;
  for (const Stretch& stretch : StretchFinder(problem, other, route, budget).Find(budget)) {
    const auto begin = taken.begin() + static_cast<std::ptrdiff_t>(stretch.first);
    const auto end = taken.begin() + static_cast<std::ptrdiff_t>(stretch.last + 1);
    if (std::find(begin, end, true) != end) continue;
    if (++tries > kMostTries || budget.Exhausted()) break;
    Route merged = With(*problem.plan, stretch, other, route);
    if (!ValidateRoute(*problem.plan, merged, &budget).ok()) continue;
    const double merged_cost = RouteCost(problem, merged, &budget);
    if (merged_cost >= cost - kImprovementTolerance) continue;
    cost = merged_cost;
    route = std::move(merged);
    std::fill(begin, end, true);
    any = true;
  }
  return any;
}

}  // namespace

void MergeRoutes(const LayerProblem& problem, Route other, Route& route, Budget& budget) {
  if (RouteCost(problem, other) < RouteCost(problem, route)) std::swap(other, route);
  while (!budget.Exhausted() && TakeStretches(problem, other, route, budget)) {
  }
}

}  // namespace traverse
