#include "engine/model/links.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace traverse {
namespace {

bool IsTime(const LinkSeconds& seconds) {
  return std::isfinite(seconds.retracted) && seconds.open >= 0 && seconds.retracted >= seconds.open;
}

bool IsPlace(const Departure& departure) {
  return !departure.from || (CoordinateFault(departure.from->x) == nullptr &&
                             CoordinateFault(departure.from->y) == nullptr);
}

// Of one end of a path: the element for it, or the one for all.
template <typename Element>
Element ElementFor(const std::vector<Element>& elements, int end) {
  if (elements.empty()) return {};
  return elements.size() == 1 ? elements[0] : elements[static_cast<size_t>(end)];
}

int ExitOf(const Path& path, int entry) {
  return path.kind == Path::Kind::kContour ? entry : 1 - entry;
}

}  // namespace

size_t ExitCount(const Path& path) {
  if (path.one_way) return 1;
  return path.allowed.empty() ? path.points.size() : path.allowed.size();
}

bool LinksFit(const LayerLinks& links, const Plan& plan) {
  if (links.empty()) return true;
  if (links.size() != plan.paths.size()) return false;
  for (size_t p = 0; p < links.size(); ++p) {
    const size_t points = plan.paths[p].points.size();
    const auto fits = [points](size_t count) { return count <= 1 || count == points; };
    const std::vector<Departure>& departures = links[p].departures;
    if (departures.size() == 1 && departures[0].from && ExitCount(plan.paths[p]) > 1) return false;
    if (!fits(departures.size()) || !fits(links[p].arrivals.size())) return false;
    if (!std::all_of(links[p].arrivals.begin(), links[p].arrivals.end(), IsTime)) return false;
    for (const Departure& departure : departures) {
      if (!IsTime(departure.seconds) || !IsPlace(departure)) return false;
    }
  }
  return true;
}

Departure DepartureOf(const LayerLinks& links, const Plan& plan, const Visit& visit) {
  if (links.empty()) return {};
  const auto path = static_cast<size_t>(visit.path);
  return ElementFor(links[path].departures, ExitOf(plan.paths[path], visit.entry));
}

LinkSeconds ArrivalOf(const LayerLinks& links, const Visit& visit) {
  if (links.empty()) return {};
  return ElementFor(links[static_cast<size_t>(visit.path)].arrivals, visit.entry);
}

}  // namespace traverse
