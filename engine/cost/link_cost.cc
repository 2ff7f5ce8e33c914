#include "engine/cost/link_cost.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <vector>

namespace traverse {
namespace {

// What a retraction takes longer for the sake of one end of a move.
double Extra(const LinkSeconds& seconds) { return seconds.retracted - seconds.open; }
double Open(const LinkSeconds& seconds) { return seconds.open; }

const LinkSeconds& SecondsOf(const Departure& departure) { return departure.seconds; }
const LinkSeconds& SecondsOf(const LinkSeconds& arrival) { return arrival; }

// The least `value` of a path's elements, and the most.
struct Range {
  double least = 0;
  double most = 0;
};

template <typename Element, typename Value>
Range RangeOver(const std::vector<Element>& elements, Value value) {
  if (elements.empty()) return {};
  const auto less = [value](const Element& a, const Element& b) {
    return value(SecondsOf(a)) < value(SecondsOf(b));
  };
  const auto [least, most] = std::minmax_element(elements.begin(), elements.end(), less);
  return {value(SecondsOf(*least)), value(SecondsOf(*most))};
}

// How far from its exit the move behind path `p` may begin, at the most, in mm.
double FarthestFrom(const LayerProblem& problem, size_t p) {
  const Path& path = problem.plan->paths[p];
  double farthest = 0;
  const auto look = [&](int entry) {
    const Visit visit{static_cast<int>(p), entry};
    const Departure departure = DepartureOf(*problem.links, *problem.plan, visit);
    if (departure.from) {
      farthest = std::max(farthest, Distance(*departure.from, ExitPoint(path, entry)));
    }
  };
  if ((*problem.links)[p].departures.empty()) return 0;
  std::for_each(path.allowed.begin(), path.allowed.end(), look);
  if (!path.allowed.empty()) return farthest;
  const int entries = path.one_way ? 1 : static_cast<int>(path.points.size());
  for (int entry = 0; entry < entries; ++entry) look(entry);
  return farthest;
}

}  // namespace

LinkCost::Left LinkCost::After(const Visit& visit) const {
  const Path& path = problem_.plan->paths[static_cast<size_t>(visit.path)];
  const Point exit = ExitPoint(path, visit.entry);
  if (problem_.links == nullptr) return {exit, {}};
  const Departure departure = DepartureOf(*problem_.links, *problem_.plan, visit);
  return {departure.from.value_or(exit), departure.seconds};
}

LinkCost::Reached LinkCost::BeginOf(const Visit& visit) const {
  const Point at = EnterPoint(problem_.plan->paths[static_cast<size_t>(visit.path)], visit.entry);
  if (problem_.links == nullptr) return {at, {}};
  return {at, ArrivalOf(*problem_.links, visit)};
}

// Of departure and arrival.
double LinkCost::SecondsOf(const Left& left, const Reached& reached, bool retracts) const {
  if (problem_.links == nullptr || travel_.is_length()) return 0;
  return retracts ? left.seconds.retracted + reached.seconds.retracted
                  : left.seconds.open + reached.seconds.open;
}

WallMove LinkCost::MoveTo(const Left& left, const Visit& visit) const {
  const Point to = BeginOf(visit).at;
  if (problem_.walls != nullptr) return problem_.walls->MoveOf(left.at, to);
  WallMove move;
  move.length_mm = Distance(left.at, to);
  move.retracts = !travel_.is_length() && move.length_mm > problem_.cost.retraction_threshold_mm;
  move.cost = travel_.OfLength(move.length_mm);
  return move;
}

double LinkCost::To(const Left& left, const Reached& reached) const {
  assert(problem_.walls_unit == 1);
  if (problem_.walls == nullptr) return AtLeastTo(left, reached);
  const WallCost::Priced move = problem_.walls->Price(left.at, reached.at);
  return move.cost + SecondsOf(left, reached, move.retracts);
}

double LinkCost::AtLeastTo(const Left& left, const Reached& reached) const {
  const double length_mm = Distance(left.at, reached.at);
  const bool retracts = length_mm > problem_.cost.retraction_threshold_mm;
  return travel_.OfLength(length_mm) + SecondsOf(left, reached, retracts);
}

CostSpec SymmetricCost(CostSpec spec, const LayerLinks& links) {
  double sum = 0;
  for (const PathLinks& path : links) {
    const Range departure = RangeOver(path.departures, Extra);
    const Range arrival = RangeOver(path.arrivals, Extra);
    sum += (departure.least + departure.most + arrival.least + arrival.most) / 2;
  }
  if (sum > 0) spec.retraction_seconds += sum / static_cast<double>(links.size());
  return spec;
}

LayerWalls SymmetricWalls(LayerWalls walls, double retraction_seconds) {
  for (KnownMove& move : walls.known) {
    if (move.retracts) move.seconds += retraction_seconds;
  }
  return walls;
}

LeastLinks LeastOf(const LayerProblem& problem) {
  LeastLinks least{problem.cost};
  const TravelCost travel(problem);
  const LayerLinks& links = *problem.links;
  const bool is_length = travel.is_length();
  double departing = problem.plan->paths.empty() ? 0 : problem.before.seconds.open;
  double last = 0;  // of the dearest departure, perhaps the last
  double extra_departing = Extra(problem.before.seconds);
  double extra_arriving = links.empty() ? 0 : std::numeric_limits<double>::infinity();
  double shorter = 0;  // by beginning elsewhere, without the retractions that this may save
  int moved = 0;
  for (size_t p = 0; p < links.size(); ++p) {
    const double mm = FarthestFrom(problem, p);
    if (mm > 0) {
      ++moved;
      shorter += is_length ? mm : travel.Motion(mm);
    }
    const double open = RangeOver(links[p].departures, Open).least;
    departing += open + RangeOver(links[p].arrivals, Open).least;
    last = std::max(last, open);
    extra_departing = std::min(extra_departing, RangeOver(links[p].departures, Extra).least);
    extra_arriving = std::min(extra_arriving, RangeOver(links[p].arrivals, Extra).least);
  }
  least.moved = moved > 0;
  least.seconds = -shorter;
  if (is_length) return least;
  if (!links.empty()) least.cost.retraction_seconds += extra_departing + extra_arriving;
  least.seconds += departing - last - moved * least.cost.retraction_seconds;
  return least;
}

}  // namespace traverse
